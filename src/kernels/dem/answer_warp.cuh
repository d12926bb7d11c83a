#pragma once

#include "backend/launch.cuh"
#include "backend/warp.cuh"
#include "kernels/dem/body_contact_impl.hpp"

namespace tread::dem
{

/// Copies between records and shared memory by all lanes of a warp, so that neighbours touch neighbouring words: a
/// record is many words long, and a lane that touches one alone touches a line for each.
template<class T>
__device__ void copy_words(T* to, const T* from, int records)
{
    constexpr int words = sizeof(T) / sizeof(double);
    static_assert(sizeof(T) == words * sizeof(double));
    auto*       target = reinterpret_cast<double*>(to);
    const auto* source = reinterpret_cast<const double*>(from);
    for (int i = static_cast<int>(threadIdx.x) % warp_size; i < records * words; i += warp_size)
    {
        target[i] = source[i];
    }
}

/// Memory of a block whose values have no constructor.
template<class T>
union Raw
{
    __device__ Raw() {}

    T value;
};

/// A warp takes `size` neighbouring pairs. Their nodes are dealt to the lanes one each, wherever one pair's end and the
/// next one's begin, because most pairs have few and some have many; what they add is then summed in the order of the
/// list, a sum a lane; at last every pair's answer is worked out by one lane.
template<class Meet, int size, int warps>
struct AnswerWarp
{
    body_contact::AnswerPair<Meet> answer;

    static constexpr int in_block = warps * size; ///< pairs

    static constexpr int sums_of_patch = sizeof(PatchSums) / sizeof(double);

    struct NodeSetting
    {
        PairLaw        law;
        RelativeMotion motion;
        Vec3<double>   arm;
        double         relaxation;
    };

    struct Shared
    {
        NodeSetting setting[size];
        NodeSums    sums[size];
        union
        {
            double value[sums_of_patch][warp_size + 1]; ///< of the nodes at hand; rows begin in different banks
            Patch  patch[size];
        };
        std::int32_t first_node[size + 1];
    };

    /// The warp's pairs.
    struct Run
    {
        std::int64_t begin;
        int          count, lane;
    };

    __device__ void operator()(std::int64_t block) const
    {
        __shared__ Raw<Shared> raw[warps];
        Shared&                shared = raw[threadIdx.x / warp_size].value;
        const PairsView&       pairs  = answer.pairs;
        const std::int64_t     begin  = (block * warps + threadIdx.x / warp_size) * size;
        const Run              run{begin, static_cast<int>(pairs.count - begin < size ? pairs.count - begin : size),
                      static_cast<int>(threadIdx.x) % warp_size};
        if (run.count <= 0) { return; }
        set_up(run, shared);
        __syncwarp();
        add_stiffnesses(run, shared);
        __syncwarp();
        add_patches(run, shared);
        __syncwarp();
        write_answers(run, shared);
    }

private:
    __device__ void set_up(const Run& run, Shared& shared) const
    {
        for (int i = run.lane; i <= run.count; i += warp_size)
        {
            shared.first_node[i] = answer.pairs.first_node[run.begin + i];
        }
        if (run.lane >= run.count) { return; }
        const body_contact::PairSetting setting =
            body_contact::setting_of(answer.pairs, answer.law, answer.bodies, answer.pairs.key[run.begin + run.lane]);
        shared.setting[run.lane] = {setting.law, setting.motion, setting.arm, 0};
        shared.sums[run.lane]    = no_nodes();
    }

    /// Shows visit(node, pair) each lane's node of the 32 from `base` on, if it has one that is inside.
    template<class Visit>
    __device__ void own_node(const Run& run, const Shared& shared, std::int32_t base, Visit visit) const
    {
        const std::int32_t i = base + run.lane;
        if (i >= shared.first_node[run.count]) { return; }
        const NodeInField node = unpacked(answer.pairs.found_node[i]);
        if (node.overlap > 0) { visit(node, static_cast<int>(answer.pairs.pair_of_node[i] - run.begin)); }
    }

    /// Every lane its own pair.
    __device__ void add_stiffnesses(const Run& run, Shared& shared) const
    {
        const bool         exists = run.lane < run.count;
        const std::int32_t first  = exists ? shared.first_node[run.lane] : 0;
        const std::int32_t last   = exists ? shared.first_node[run.lane + 1] : 0;
        Stiffness          found{0, 0};
        for (std::int32_t base = shared.first_node[0]; base < shared.first_node[run.count]; base += warp_size)
        {
            Stiffness own{0, 0};
            own_node(run, shared, base,
                     [&](const NodeInField& node, int pair)
                     {
                         const bool wall = second_of(answer.pairs.key[run.begin + pair]) >= answer.bodies;
                         add_stiffness(shared.setting[pair].law, node, wall ? 1.0 : Meet::stiffening(node), own);
                     });
            __syncwarp();
            shared.value[0][run.lane] = own.sum;
            shared.value[1][run.lane] = own.overlap;
            __syncwarp();
            for (std::int32_t i = max(first, base); i < min(last, base + warp_size); ++i)
            {
                found.sum += shared.value[0][i - base];
                found.overlap = fmax(found.overlap, shared.value[1][i - base]);
            }
        }
        if (!exists) { return; }
        shared.sums[run.lane].stiffness = found;
        NodeSetting& setting            = shared.setting[run.lane];
        setting.relaxation              = found.sum > 0 ? relaxation_time(setting.law, found.sum) : 0.0;
    }

    /// Every lane one sum of one pair, and then the next.
    __device__ void add_patches(const Run& run, Shared& shared) const
    {
        const std::int32_t end = shared.first_node[run.count];
        for (std::int32_t base = shared.first_node[0]; base < end; base += warp_size)
        {
            PatchSums own = PatchSums::zero();
            own_node(run, shared, base,
                     [&](const NodeInField& node, int pair)
                     {
                         const NodeSetting& setting = shared.setting[pair];
                         add_node(setting.law, node, setting.motion, setting.relaxation, own);
                     });
            double values[sums_of_patch];
            own.write_to(values);
            __syncwarp();
#pragma unroll
            for (int c = 0; c < sums_of_patch; ++c) { shared.value[c][run.lane] = values[c]; }
            __syncwarp();
            const auto pair_of = [&](std::int32_t i)
            { return static_cast<int>(answer.pairs.pair_of_node[i] - run.begin); };
            const int first = pair_of(base), pairs = pair_of(min(end, base + warp_size) - 1) - first + 1;
            for (int item = run.lane; item < pairs * sums_of_patch; item += warp_size)
            {
                add_values(first + item / sums_of_patch, item % sums_of_patch, base, shared);
            }
        }
    }

    /// Of one pair, to sum c of its patch, what its nodes from `base` on said.
    __device__ static void add_values(int pair, int c, std::int32_t base, Shared& shared)
    {
        double&   sum   = reinterpret_cast<double*>(&shared.sums[pair].patch)[c];
        const int first = max(shared.first_node[pair] - base, 0);
        const int last  = min(shared.first_node[pair + 1] - base, warp_size);
        double    found = sum;
        for (int i = first; i < last; ++i) { found += shared.value[c][i]; }
        sum = found;
    }

    __device__ void write_answers(const Run& run, Shared& shared) const
    {
        const PairsView&   pairs  = answer.pairs;
        const bool         exists = run.lane < run.count;
        const std::int64_t p      = run.begin + run.lane;
        if (exists)
        {
            const NodeSetting&              known   = shared.setting[run.lane];
            const body_contact::PairSetting setting = {known.law, known.motion, known.arm,
                                                       body_contact::wall_of(answer.law, answer.bodies, pairs.key[p])};
            Patch                           patch   = pairs.patch[p];
            answer.touch_spheres(p, setting, shared.sums[run.lane]);
            answer.write(p, answer.answer(p, setting, shared.sums[run.lane], patch));
            shared.patch[run.lane] = patch;
        }
        __syncwarp();
        copy_words(pairs.patch + run.begin, shared.patch, run.count);
    }
};

} // namespace tread::dem
