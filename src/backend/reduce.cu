#include "backend/launch.cuh"
#include "backend/reduce.hpp"

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

constexpr int fold_threads = 256;

/// One block a column: each thread folds a fixed stride of rows, then a fixed tree folds the threads.
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
        double            value = 0;
        for (std::int64_t i = threadIdx.x; i < count; i += fold_threads)
        {
            value = combine(value, rows[i * width + column]);
        }
        partial[threadIdx.x] = value;
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
};

} // namespace

void sum_rows(const Gpu& gpu, const double* rows, std::int64_t count, int width, double* out)
{
    for_each_block<fold_threads>(gpu, "sum rows", width, FoldColumn<Add>{rows, count, width, out, {}});
}

void largest_of_rows(const Gpu& gpu, const double* rows, std::int64_t count, int width, double* out)
{
    for_each_block<fold_threads>(gpu, "largest of rows", width, FoldColumn<Larger>{rows, count, width, out, {}});
}

} // namespace tread
