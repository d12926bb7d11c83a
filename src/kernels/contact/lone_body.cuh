#pragma once

#include "backend/block_sum.cuh"
#include "backend/cooperative.cuh"
#include "kernels/contact/point_contact_kern.hpp"
#include "kernels/dem/contact/warp_lanes.cuh"

// Substeps of one body that touches only sand. A thread holds its point and their contact record; every block
// integrates the body in its own memory, with the same sums in the same order as all other blocks. Blocks therefore
// synchronise only once per substep, for their parts of the wrench.
namespace tread::contact::contact_steps
{

inline constexpr int lone_threads = 256, lone_blocks_an_sm = 2;

/// Sums the parts of all blocks; every lane returns the sum.
template<class Lanes>
__device__ dem::ContactWrench sum_of_blocks(const dem::ContactWrench* part, std::int32_t blocks, const Lanes& lanes)
{
    dem::ContactWrench sum = dem::ContactWrench::zero();
    for (std::int32_t i = lanes.lane(); i < blocks; i += lanes.lanes()) { sum = sum + part[i]; }
    dem::moving::reduce(sum, lanes);
    return sum;
}

/// External wrench on the body that is already summed.
struct KnownWrench
{
    static constexpr bool acts = true;

    dem::ContactWrench wrench;

    template<class Lanes>
    TREAD_HD dem::ContactWrench operator()(std::int64_t, const Lanes&) const
    {
        return wrench;
    }
};

/// Variable state of the body, with its totals.
struct LoneBodyState
{
    Vec3<double>        position;
    Quat                orientation;
    Vec3<double>        velocity;
    Vec3<double>        angular_velocity;
    Vec3<double>        force;
    Vec3<double>        torque;
    double              stiffness;
    dem::BodyTotal      total;
    dem::ContactImpulse impulse;
    std::int32_t        number; ///< of the present substep
    std::int32_t        last;   ///< as in DisplacementLimit
};

/// Move: dem::moving::Move of the body in device memory, with KnownWrench as external wrench. Every point has a thread.
template<class Move>
struct LoneBody
{
    Respond           respond;
    RunsView          by_point;
    PointMotion       motion;
    Move              move;
    dem::ContactBody* shown; ///< for contacts between bodies; null if pairs were never found
    dem::ContactWrench*
        parts; ///< [2 blocks], of this substep and of the previous one, which other blocks may still be reading

    /// Contact and motion of a thread's point.
    struct Own
    {
        bool          there;
        std::int64_t  t, c; ///< indices of the point and of its candidate
        MovingPoint   point;
        PairConstants pair;
        Tangential    tangential;
        double        dissipated;
    };

    __device__ void operator()(std::int64_t substeps, const cooperative_groups::grid_group& grid) const
    {
        __shared__ alignas(LoneBodyState) unsigned char memory[sizeof(LoneBodyState)];
        LoneBodyState&                                  state = *reinterpret_cast<LoneBodyState*>(memory);
        if (threadIdx.x == 0) { read(state); }
        __syncthreads();
        const Move in_block = move_of(state);
        Own        own      = read_own();
        for (std::int64_t substep = 0; substep < substeps && !is_over(state); ++substep)
        {
            dem::ContactWrench* of_blocks = parts + substep % 2 * gridDim.x;
            Response*           kept      = substep + 1 == substeps ? respond.contacts.response + own.c : nullptr;
            sum_of_block(answer(own, in_block.bodies, kept), of_blocks + blockIdx.x);
            if (threadIdx.x == 0) { state.number = move.limit.substep + static_cast<std::int32_t>(substep); }
            grid.sync();
            if (threadIdx.x < warp_size) { move_body(of_blocks, in_block); }
            __syncthreads();
        }
        write_own(own);
        if (blockIdx.x == 0 && threadIdx.x == 0) { write(state); }
    }

private:
    __device__ void read(LoneBodyState& state) const
    {
        const dem::BodiesView& from = move.bodies;
        state                       = {from.position[0],
                                       from.orientation[0],
                                       from.velocity[0],
                                       from.angular_velocity[0],
                                       from.force[0],
                                       from.torque[0],
                                       from.stiffness[0],
                                       move.totals[0],
                                       {},
                                       0,
                                       0};
        if (move.named.count > 0) { state.impulse = move.named.impulse[0]; }
        if (move.limit.last != nullptr) { state.last = *move.limit.last; }
    }

    __device__ void write(const LoneBodyState& state) const
    {
        const dem::BodiesView& to = move.bodies;
        to.position[0]            = state.position;
        to.orientation[0]         = state.orientation;
        to.velocity[0]            = state.velocity;
        to.angular_velocity[0]    = state.angular_velocity;
        to.force[0]               = state.force;
        to.torque[0]              = state.torque;
        to.stiffness[0]           = state.stiffness;
        move.totals[0]            = state.total;
        if (move.named.count > 0) { move.named.impulse[0] = state.impulse; }
        if (shown != nullptr) { store(shown, contact_body(to, 0)); }
        if (state.last != 0) { *move.limit.last = state.last; }
    }

    /// Whether the list of pairs has expired.
    __device__ static bool is_over(const LoneBodyState& state) { return state.last != 0 && state.number >= state.last; }

    /// Returns the Move of a block's own copy of the body.
    __device__ Move move_of(LoneBodyState& state) const
    {
        Move own                    = move;
        own.bodies.position         = &state.position;
        own.bodies.orientation      = &state.orientation;
        own.bodies.velocity         = &state.velocity;
        own.bodies.angular_velocity = &state.angular_velocity;
        own.bodies.force            = &state.force;
        own.bodies.torque           = &state.torque;
        own.bodies.stiffness        = &state.stiffness;
        own.totals                  = &state.total;
        own.named.impulse           = &state.impulse;
        own.pairs                   = {};
        own.limit.last              = &state.last;
        own.limit.repeated          = &state.number;
        return own;
    }

    /// Moves the body; called by one warp.
    __device__ static void move_body(const dem::ContactWrench* of_blocks, const Move& in_block)
    {
        const dem::GroupLanes<warp_size> warp;
        Move                             moved = in_block;
        moved.outside                          = {sum_of_blocks(of_blocks, static_cast<std::int32_t>(gridDim.x), warp)};
        if (warp.lane() == 0) { moved(0, dem::OneLane{}); }
    }

    __device__ Own read_own() const
    {
        Own own{};
        own.t     = std::int64_t{blockIdx.x} * lone_threads + threadIdx.x;
        own.there = own.t < by_point.count;
        if (!own.there) { return own; }
        own.c          = respond.contacts.candidates.in_order[by_point.first[own.t]];
        own.point      = moving_point(respond.points, own.t);
        own.pair       = respond.pair(0, static_cast<std::int32_t>(own.t), shape());
        own.tangential = respond.contacts.tangential[own.c];
        own.dissipated = respond.contacts.dissipated[own.c];
        return own;
    }

    __device__ void write_own(const Own& own) const
    {
        if (!own.there) { return; }
        store(own.point, respond.points, own.t);
        respond.contacts.tangential[own.c] = own.tangential;
        respond.contacts.dissipated[own.c] = own.dissipated;
    }

    __device__ const dem::TemplateView& shape() const { return respond.law.templates[respond.bodies.shape[0]]; }

    /// Returns the wrench of a thread's contact on the body, and moves its point. Stores the response in `kept` unless
    /// null.
    __device__ dem::ContactWrench answer(Own& own, const dem::BodiesView& body, Response* kept) const
    {
        if (!own.there) { return dem::ContactWrench::zero(); }
        const Vec3<double> x = own.point.position;
        const Response     response =
            response_of(body, 0, shape(), own.pair, x, own.point.velocity, own.tangential, respond.dt);
        own.dissipated += response.dissipated;
        if (kept != nullptr) { *kept = response; }
        own.point.move(response.force, motion, respond.dt);
        return wrench_on_body(response, x - body.position[0]);
    }

    __device__ static void sum_of_block(const dem::ContactWrench& wrench, dem::ContactWrench* sum)
    {
        constexpr int     width = sizeof(dem::ContactWrench) / sizeof(double);
        __shared__ double scratch[lone_threads / warp_size * width];
        block_sum<lone_threads, width>(reinterpret_cast<const double*>(&wrench), scratch,
                                       [&](int which, double value) { reinterpret_cast<double*>(sum)[which] = value; });
    }
};

template<class Move>
__global__ void __launch_bounds__(lone_threads, lone_blocks_an_sm)
    lone_body_kernel(std::int64_t substeps, const __grid_constant__ LoneBody<Move> lone)
{
    lone(substeps, cooperative_groups::this_grid());
}

} // namespace tread::contact::contact_steps
