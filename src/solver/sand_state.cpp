#include <fmt/format.h>

#include "solver/sand.hpp"
#include "solver/state_file.hpp"

// The sand into a checkpoint, and out of it.
namespace tread::solver
{

/// Points that are listed need nothing of the last step any more but what they are.
template<class Exec, class Real>
void Sand<Exec, Real>::transfer(StateFile& file)
{
    if (!file.loads()) { order(); }
    transfer_points(file, points_, "points");
    file.numbers("sand/steps", step_, relists_, orders_, mass_);
    if (file.exact())
    {
        pages_.for_each_field([&](const char* name, auto& array) { file.own(fmt::format("pages/{}", name), array); });
        if (ranks_) { ranks_->transfer(file); }
        if (file.loads()) { resume_lists(); }
        if (sleep_)
        {
            transfer_points(file, sleep_->points(), "asleep");
            sleep_->transfer(file, pages_, pages(), order_scratch_.sort);
        }
    }
    if (!file.loads()) { return; }
    if (!file.exact())
    {
        order_in_memory();
        migrated_ = 0; // what belongs to the points did not wait for them elsewhere
    }
    listed_ = true;
    steps_  = 0;
}

template<class Exec, class Real>
void Sand<Exec, Real>::transfer_points(StateFile& file, mpm::Points<Exec, Real>& points, const std::string& folder)
{
    StateFile::Share rows{0, points.count};
    if (file.loads())
    {
        rows = file.share(fmt::format("{}/id_0", folder));
        points.reserve(rows.count);
        points.count = rows.count;
    }
    points.for_each_named_field(
        [&](const char* name, auto& field, int components)
        {
            for (int c = 0; c < components; ++c)
            {
                file.plane(exec_, fmt::format("{}/{}_{}", folder, name, c), field.data() + c * points.stride, rows);
            }
        });
}

template<class Exec, class Real>
void Sand<Exec, Real>::resume_lists()
{
    if (ranks_) { ranks_->resume(pages_, walls_); }
    make_room();
    stirred_in_.fill_zero();
}

template void Sand<Cpu, float>::transfer(StateFile&);
template void Sand<Cpu, double>::transfer(StateFile&);
#ifdef TREAD_WITH_CUDA
template void Sand<Gpu, float>::transfer(StateFile&);
template void Sand<Gpu, double>::transfer(StateFile&);
#endif

} // namespace tread::solver
