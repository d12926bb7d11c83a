#include "backend/launch.cuh"
#include "backend/reduce.hpp"
#include "backend/warp.cuh"

namespace tread
{
namespace
{

struct Add
{
    __device__ double operator()(double a, double b) const { return a + b; }
};

struct Larger
{
    __device__ double operator()(double a, double b) const { return a > b ? a : b; }
};

constexpr int fold_threads = 1024;
constexpr int fold_lanes   = 4; ///< loads in flight per thread

/// Runs one block per column: each thread folds rows at a fixed stride, then a fixed tree folds the threads.
template<class Combine>
struct FoldColumn
{
    const double* rows;
    std::int64_t  count;
    int           width;
    double*       out;
    Combine       combine;

    __device__ void operator()(std::int64_t column) const
    {
        __shared__ double partial[fold_threads];
        partial[threadIdx.x] = fold_stride(column);
        __syncthreads();
        for (unsigned half = fold_threads / 2; half > 0; half /= 2)
        {
            if (threadIdx.x < half)
            {
                partial[threadIdx.x] = combine(partial[threadIdx.x], partial[threadIdx.x + half]);
            }
            __syncthreads();
        }
        if (threadIdx.x == 0) { out[column] = partial[0]; }
    }

    __device__ double fold_stride(std::int64_t column) const
    {
        double value[fold_lanes] = {};
        for (std::int64_t first = threadIdx.x; first < count; first += fold_lanes * fold_threads)
        {
#pragma unroll
            for (int lane = 0; lane < fold_lanes; ++lane)
            {
                const std::int64_t row = first + lane * fold_threads;
                if (row < count) { value[lane] = combine(value[lane], rows[row * width + column]); }
            }
        }
#pragma unroll
        for (int half = fold_lanes / 2; half > 0; half /= 2)
        {
#pragma unroll
            for (int lane = 0; lane < half; ++lane) { value[lane] = combine(value[lane], value[lane + half]); }
        }
        return value[0];
    }
};

constexpr int          chunk_threads = 256;
constexpr std::int64_t chunks        = 256;
constexpr std::int64_t many_rows     = 16 * chunks;

/// Runs one block per chunk of rows; a thread sums rows at a fixed stride in one column, so that rows are read
/// contiguously.
struct SumChunk
{
    const double* rows;
    std::int64_t  count;
    int           width;
    double*       out;

    __device__ void operator()(std::int64_t chunk) const
    {
        __shared__ double  partial[chunk_threads];
        const int          lines = chunk_threads / width, column = static_cast<int>(threadIdx.x) % width;
        const std::int64_t end = (chunk + 1) * count / chunks;
        double             sum = 0;
        if (static_cast<int>(threadIdx.x) < lines * width)
        {
            for (std::int64_t row = chunk * count / chunks + threadIdx.x / width; row < end; row += lines)
            {
                sum += rows[row * width + column];
            }
        }
        partial[threadIdx.x] = sum;
        __syncthreads();
        if (static_cast<int>(threadIdx.x) >= width) { return; }
        for (int line = 1; line < lines; ++line) { sum += partial[line * width + column]; }
        out[chunk * width + column] = sum;
    }
};

/// Runs one block per chunk of a column's rows. Non-negative floating-point numbers are ordered as their bit patterns.
struct LargestOfChunk
{
    const double*       rows;
    std::int64_t        count;
    int                 width;
    unsigned long long* out;

    __device__ void operator()(std::int64_t block) const
    {
        const std::int64_t column = block / chunks, chunk = block % chunks, end = (chunk + 1) * count / chunks;
        double             largest = 0;
        for (std::int64_t row = chunk * count / chunks + threadIdx.x; row < end; row += chunk_threads)
        {
            largest = Larger{}(rows[row * width + column], largest); // in this order -0 does not replace it
        }
        for (int across = warp_size / 2; across > 0; across /= 2)
        {
            largest = Larger{}(largest, __shfl_xor_sync(all_lanes, largest, across));
        }
        if (threadIdx.x % warp_size == 0)
        {
            atomicMax(out + column, static_cast<unsigned long long>(__double_as_longlong(largest)));
        }
    }
};

} // namespace

void sum_rows(const Gpu& gpu, const double* rows, std::int64_t count, int width, double* out,
              Array<Gpu, double>& scratch)
{
    if (count < many_rows)
    {
        sum_rows(gpu, rows, count, width, out);
        return;
    }
    scratch.resize(chunks * width);
    for_each_block<chunk_threads>(gpu, "sum chunks of rows", chunks, SumChunk{rows, count, width, scratch.data()});
    sum_rows(gpu, scratch.data(), chunks, width, out);
}

void sum_rows(const Gpu& gpu, const double* rows, std::int64_t count, int width, double* out)
{
    if (count >= many_rows)
    {
        Array<Gpu, double> scratch(gpu, "sums of chunks");
        sum_rows(gpu, rows, count, width, out, scratch);
        return;
    }
    for_each_block<fold_threads>(gpu, "sum rows", width, FoldColumn<Add>{rows, count, width, out, {}});
}

void largest_of_rows(const Gpu& gpu, const double* rows, std::int64_t count, int width, double* out)
{
    if (count >= many_rows)
    {
        fill_zero(gpu, out, static_cast<std::size_t>(width) * sizeof(double));
        for_each_block<chunk_threads>(gpu, "largest of rows", chunks * width,
                                      LargestOfChunk{rows, count, width, reinterpret_cast<unsigned long long*>(out)});
        return;
    }
    for_each_block<fold_threads>(gpu, "largest of rows", width, FoldColumn<Larger>{rows, count, width, out, {}});
}

} // namespace tread
