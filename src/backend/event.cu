#include "backend/event.hpp"

#include "backend/cuda_check.cuh"

namespace tread
{

Event<Gpu>::Event(const Gpu& gpu)
    : gpu_(gpu)
{
    check_cuda(cudaEventCreateWithFlags(&event_, cudaEventDisableTiming), "mark in a stream");
}

Event<Gpu>::~Event() { cudaEventDestroy(event_); }

void Event<Gpu>::mark() { check_cuda(cudaEventRecord(event_, gpu_.stream), "mark in a stream"); }

void Event<Gpu>::wait() const { check_cuda(cudaEventSynchronize(event_), "wait for a mark in a stream"); }

} // namespace tread
