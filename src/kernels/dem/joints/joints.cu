#include "backend/instantiate.hpp"
#include "backend/launch.cuh"
#include "kernels/dem/contact/warp_lanes.cuh"
#include "kernels/dem/joints/joints_impl.hpp"

namespace tread::dem
{
namespace
{

constexpr int joint_threads = 512;

/// The threads of one block, in warps.
struct BlockTeam
{
    __device__ static std::int64_t          lane() { return threadIdx.x; }
    __device__ static std::int64_t          lanes() { return joint_threads; }
    __device__ static std::int64_t          group() { return threadIdx.x / warp_size; }
    __device__ static std::int64_t          groups() { return joint_threads / warp_size; }
    __device__ static GroupLanes<warp_size> members() { return {}; }
    __device__ static void                  sync() { __syncthreads(); }
};

/// Keeps the factor in shared memory where it fits: some 100 rows.
struct ByBlock
{
    joint_steps::SolveJoints solve;

    __device__ void operator()(std::int64_t) const
    {
        constexpr std::int64_t room = 6000;
        __shared__ double      shared[room];
        const std::int64_t     size = factor_size(solve.joints.row_count);
        solve(size <= room ? shared : solve.joints.factor, BlockTeam{});
    }
};

} // namespace

template<class Exec>
void solve_joints(const Exec& gpu, const BodyStep<Exec>& step)
{
    for_each_block<joint_threads>(gpu, "joints", 1, ByBlock{joint_steps::make_solve(step)});
}

#define TREAD_INSTANTIATE(Exec) template void solve_joints(const Exec&, const BodyStep<Exec>&)
TREAD_FOR_THIS_BACKEND(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::dem
