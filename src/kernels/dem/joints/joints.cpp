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

std::vector<std::int32_t> row_counts_of(const std::vector<Joint>& joints)
{
    std::vector<std::int32_t> counts;
    counts.reserve(joints.size());
    for (const Joint& joint : joints) { counts.push_back(joint_rows::rows_of(joint)); }
    return counts;
}

/// States at the start: no joint is at a limit. `joints` have their rows numbered.
std::vector<std::int32_t> first_states(const std::vector<Joint>& joints, std::int32_t rows)
{
    std::vector<std::int32_t> states(static_cast<std::size_t>(rows), row_solved);
    for (const Joint& joint : joints)
    {
        if ((joint.parts & joint_has_limits) == 0) { continue; }
        const auto end = states.begin() + joint.first_row + joint.row_count;
        std::fill(end - 2, end, row_at_low);
    }
    return states;
}

/// Rows of the joints of each body of `bodies`, ascending. `joints` have their rows numbered.
IndexLists rows_of_bodies(const std::vector<std::int32_t>& bodies, const std::vector<Joint>& joints)
{
    IndexLists rows;
    for (const std::int32_t body : bodies)
    {
        const auto begin = static_cast<std::ptrdiff_t>(rows.item.size());
        for (std::size_t j = 0; j < joints.size(); ++j)
        {
            if (bodies_of(joints, j).count(static_cast<std::size_t>(body)) == 0) { continue; }
            for (std::int32_t r = 0; r < joints[j].row_count; ++r) { rows.item.push_back(joints[j].first_row + r); }
        }
        std::sort(rows.item.begin() + begin, rows.item.end());
        rows.close();
    }
    return rows;
}

} // namespace

template<class Exec>
std::vector<Joint> Joints<Exec>::numbered(std::vector<Joint> joints) const
{
    for (std::size_t j = 0; j < joints.size(); ++j)
    {
        joints[j].first_row = plan_.first_row[j];
        joints[j].row_count = joint_rows::rows_of(joints[j]);
    }
    return joints;
}

template<class Exec>
Joints<Exec>::Joints(const Exec& exec, std::vector<Joint> joints, std::int64_t body_count)
    : plan_(plan_elimination(joints, row_counts_of(joints)))
    , bodies_(jointed_bodies(joints))
    , joint_(exec, "joints")
    , body_(exec, "jointed bodies")
    , place_(exec, "places of jointed bodies")
    , link_(exec, "jointed bodies without joints", static_cast<std::int64_t>(bodies_.size()))
    , moved_(exec, "jointed bodies with joints", static_cast<std::int64_t>(bodies_.size()))
    , row_(exec, "joint rows", plan_.row_count)
    , state_(exec, "joint row states")
    , factor_(exec, "joint factor", factor_size(plan_.row_count))
    , wrench_(exec, "joint wrenches", static_cast<std::int64_t>(bodies_.size()))
    , record_(exec, "joint records", static_cast<std::int64_t>(joints.size()))
    , changed_(exec, "joint rows that changed", 1)
    , levels_(exec, "joint levels", plan_.levels)
    , below_(exec, "joint rows below", plan_.below)
    , targets_(exec, "joint rows that a level changes", plan_.targets)
    , changed_by_(exec, "joints that change a row", plan_.changed_by)
    , rows_of_link_(exec, "rows of jointed bodies", rows_of_bodies(bodies_, numbered(joints)))
{
    joints = numbered(std::move(joints));
    std::vector<std::int32_t> place(static_cast<std::size_t>(body_count), -1);
    for (std::size_t k = 0; k < bodies_.size(); ++k)
    {
        place[static_cast<std::size_t>(bodies_[k])] = static_cast<std::int32_t>(k);
    }
    joint_.assign(joints);
    body_.assign(bodies_);
    place_.assign(place);
    state_.assign(first_states(joints, plan_.row_count));
    wrench_.fill_zero();
    record_.fill_zero();
}

template<class Exec>
JointsView Joints<Exec>::view()
{
    return {joint_.size(),      body_.size(),        row_.size(),
            joint_.data(),      body_.data(),        place_.data(),
            link_.data(),       moved_.data(),       row_.data(),
            state_.data(),      factor_.data(),      wrench_.data(),
            record_.data(),     changed_.data(),     static_cast<std::int64_t>(plan_.levels.first.size()) - 1,
            levels_.view(),     below_.view(),       targets_.view(),
            changed_by_.view(), rows_of_link_.view()};
}

template<class Exec>
void solve_joints(const Exec& cpu, const BodyStep<Exec>& step)
{
    cpu.counters->launched("joints");
    if (cpu.number.is_over()) { return; }
    joint_steps::make_solve(step)(step.joints.factor, OneThread{});
}

#define TREAD_INSTANTIATE(Exec) template class Joints<Exec>
TREAD_FOR_BACKENDS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

#define TREAD_INSTANTIATE(Exec) template void solve_joints(const Exec&, const BodyStep<Exec>&)
TREAD_FOR_THIS_BACKEND(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::dem
