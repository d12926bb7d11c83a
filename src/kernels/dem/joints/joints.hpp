#pragma once

#include <vector>

#include "backend/array.hpp"
#include "kernels/dem/joints/joint_rows.hpp"
#include "kernels/dem/motion/move.hpp"

namespace tread::dem
{

/// Memory of an IndexListsView.
template<class Exec>
struct ListArrays
{
    Array<Exec, std::int32_t> first;
    Array<Exec, std::int32_t> item;

    ListArrays(const Exec& exec, const char* name, const IndexLists& lists)
        : first(exec, name)
        , item(exec, name)
    {
        first.assign(lists.first);
        item.assign(lists.item);
    }

    IndexListsView view() const { return {first.data(), item.data()}; }
};

/// Memory of JointsView.
template<class Exec>
class Joints
{
public:
    /// Joints of a scene with `body_count` bodies; fills first_row and row_count. `joints` is not empty.
    Joints(const Exec& exec, std::vector<Joint> joints, std::int64_t body_count);

    JointsView view();

    /// Changes the joints' numbers (motors of another phase, say); kinds, bodies and parts stay.
    void update(const std::vector<Joint>& joints) { joint_.assign(numbered(joints)); }

    /// Sets the records to zero.
    void clear_records() { record_.fill_zero(); }

    std::vector<JointRecord> records() const { return record_.to_host(); }

    /// States of the rows and records, which later substeps depend on.
    Array<Exec, std::int32_t>& states() { return state_; }
    Array<Exec, JointRecord>&  record() { return record_; }

    /// Indices of the bodies with joints, ascending.
    const std::vector<std::int32_t>& bodies() const { return bodies_; }

private:
    std::vector<Joint> numbered(std::vector<Joint> joints) const;

    Elimination               plan_;
    std::vector<std::int32_t> bodies_;
    Array<Exec, Joint>        joint_;
    Array<Exec, std::int32_t> body_;
    Array<Exec, std::int32_t> place_;
    Array<Exec, JointLink>    link_;
    Array<Exec, JointLink>    moved_;
    Array<Exec, JointRow>     row_;
    Array<Exec, std::int32_t> state_;
    Array<Exec, double>       factor_;
    Array<Exec, JointWrench>  wrench_;
    Array<Exec, JointRecord>  record_;
    Array<Exec, std::int32_t> changed_;

    ListArrays<Exec> levels_;
    ListArrays<Exec> below_;
    ListArrays<Exec> targets_;
    ListArrays<Exec> changed_by_;
    ListArrays<Exec> rows_of_link_;
};

/// Computes the wrenches of the joints for the substep that move_bodies is about to do, from the same contact forces:
/// velocities after it remove the joints' errors within the substep. On several ranks each rank with a jointed body
/// has all of them, and reaches the same bits. One block on a GPU; allocates nothing.
template<class Exec>
void solve_joints(const Exec&, const BodyStep<Exec>& step);

} // namespace tread::dem
