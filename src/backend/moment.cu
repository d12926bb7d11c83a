#include "backend/moment.hpp"

#include "backend/cuda_check.cuh"

namespace tread
{

Moment<Gpu>::Moment(const Gpu& gpu)
    : gpu_(gpu)
{
    check_cuda(cudaEventCreateWithFlags(&event_, cudaEventDisableTiming), "mark in a stream");
}

Moment<Gpu>::~Moment() { cudaEventDestroy(event_); }

void Moment<Gpu>::mark() { check_cuda(cudaEventRecord(event_, gpu_.stream), "mark in a stream"); }

void Moment<Gpu>::wait() const { check_cuda(cudaEventSynchronize(event_), "wait for a mark in a stream"); }

} // namespace tread
