#include "kernels/dem/joints/joints.hpp"

#include <algorithm>
#include <utility>

#include "backend/counters.hpp"
#include "backend/instantiate.hpp"
#include "kernels/dem/joints/joints_impl.hpp"

namespace tread::dem
{
namespace
{

/// The calling thread alone.
struct OneThread
{
    static std::int64_t lane() { return 0; }
    static std::int64_t lanes() { return 1; }
    static std::int64_t group() { return 0; }
    static std::int64_t groups() { return 1; }
    static OneLane      members() { return {}; }
    static void         sync() {}
};

std::vector<std::int32_t> jointed_bodies(const std::vector<Joint>& joints)
{
    std::vector<std::int32_t> bodies;
    for (const Joint& joint : joints)
    {
        if (joint.kind == joint_differential) { continue; } // its revolute joints name its bodies
        for (const std::int32_t b : joint.body)
        {
            if (b != joint_world) { bodies.push_back(b); }
        }
    }
    std::sort(bodies.begin(), bodies.end());
    bodies.erase(std::unique(bodies.begin(), bodies.end()), bodies.end());
    return bodies;
}

/// States at the start: no joint is at a limit.
std::vector<std::int32_t> first_states(const std::vector<Joint>& joints)
{
    std::vector<std::int32_t> states;
    for (const Joint& joint : joints)
    {
        states.insert(states.end(), static_cast<std::size_t>(joint.row_count), row_solved);
        if ((joint.parts & joint_has_limits) != 0) { std::fill(states.end() - 2, states.end(), row_at_low); }
    }
    return states;
}

} // namespace

template<class Exec>
std::vector<Joint> Joints<Exec>::numbered(std::vector<Joint> joints)
{
    std::int32_t row = 0;
    for (Joint& joint : joints)
    {
        joint.first_row = row;
        joint.row_count = joint_rows::rows_of(joint);
        row += joint.row_count;
    }
    return joints;
}

template<class Exec>
Joints<Exec>::Joints(const Exec& exec, std::vector<Joint> joints, std::int64_t body_count)
    : bodies_(jointed_bodies(joints))
    , joint_(exec, "joints")
    , body_(exec, "jointed bodies")
    , place_(exec, "places of jointed bodies")
    , link_(exec, "jointed bodies without joints", static_cast<std::int64_t>(bodies_.size()))
    , moved_(exec, "jointed bodies with joints", static_cast<std::int64_t>(bodies_.size()))
    , row_(exec, "joint rows")
    , state_(exec, "joint row states")
    , matrix_(exec, "joint matrix")
    , wrench_(exec, "joint wrenches", static_cast<std::int64_t>(bodies_.size()))
    , record_(exec, "joint records", static_cast<std::int64_t>(joints.size()))
    , changed_(exec, "joint rows that changed", 1)
{
    joints = numbered(std::move(joints));
    std::vector<std::int32_t> place(static_cast<std::size_t>(body_count), -1);
    for (std::size_t k = 0; k < bodies_.size(); ++k)
    {
        place[static_cast<std::size_t>(bodies_[k])] = static_cast<std::int32_t>(k);
    }
    const std::int64_t rows = joints.back().first_row + joints.back().row_count;
    joint_.assign(joints);
    body_.assign(bodies_);
    place_.assign(place);
    row_.resize(rows);
    state_.assign(first_states(joints));
    matrix_.resize(rows * (rows + 1));
    wrench_.fill_zero();
    record_.fill_zero();
}

template<class Exec>
JointsView Joints<Exec>::view()
{
    return {joint_.size(),  body_.size(),   row_.size(),    joint_.data(),  body_.data(),
            place_.data(),  link_.data(),   moved_.data(),  row_.data(),    state_.data(),
            matrix_.data(), wrench_.data(), record_.data(), changed_.data()};
}

template<class Exec>
void solve_joints(const Exec& cpu, const BodyStep<Exec>& step)
{
    cpu.counters->launched("joints");
    joint_steps::make_solve(step)(OneThread{});
}

#define TREAD_INSTANTIATE(Exec) template class Joints<Exec>
TREAD_FOR_BACKENDS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

#define TREAD_INSTANTIATE(Exec) template void solve_joints(const Exec&, const BodyStep<Exec>&)
TREAD_FOR_THIS_BACKEND(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::dem
