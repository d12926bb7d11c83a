#include "backend/cuda_check.cuh"
#include "backend/secondary_stream.hpp"

namespace tread
{
namespace
{

void let_wait(CUstream_st* later, CUstream_st* earlier, CUevent_st* reached)
{
    check_cuda(cudaEventRecord(reached, earlier), "mark in a stream");
    check_cuda(cudaStreamWaitEvent(later, reached, 0), "wait for a stream");
}

} // namespace

SecondaryStream<Gpu>::SecondaryStream(const Gpu& first)
    : first_(first)
    , second_{nullptr, first.counters}
{
    int lowest = 0, highest = 0;
    check_cuda(cudaDeviceGetStreamPriorityRange(&lowest, &highest), "priorities of streams");
    check_cuda(cudaStreamCreateWithPriority(&second_.stream, cudaStreamDefault, highest), "second stream");
    check_cuda(cudaEventCreateWithFlags(&reached_, cudaEventDisableTiming), "mark in a stream");
}

SecondaryStream<Gpu>::~SecondaryStream()
{
    cudaEventDestroy(reached_);
    cudaStreamDestroy(second_.stream);
}

void SecondaryStream<Gpu>::fork() { let_wait(second_.stream, first_.stream, reached_); }

void SecondaryStream<Gpu>::join() { let_wait(first_.stream, second_.stream, reached_); }

} // namespace tread
