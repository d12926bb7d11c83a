#include <string_view>

#include <fmt/format.h>

#include "solver/sand.hpp"
#include "solver/state_file.hpp"

// The sand into a checkpoint, and out of it.
namespace tread::solver
{
namespace
{

/// Whether a field of the points stays what it was when they were built. Those that do are built again, not saved: 33
/// bytes a point.
bool lasts(std::string_view name)
{
    return name == "start" || name == "mass" || name == "volume" || name == "material";
}

} // namespace

/// Points that are listed need nothing of the last step any more but what they are.
template<class Exec, class Real>
void Sand<Exec, Real>::transfer(StateFile& file, const HostPoints& built)
{
    if (!file.loads()) { order(); }
    transfer_points(file, points_, "points");
    if (file.loads()) { restore_lasting(points_, built); }
    file.numbers("sand/steps", step_, relists_, orders_, mass_);
    file.doubles("sand/left", left_);
    if (file.exact())
    {
        pages_.for_each_field([&](const char* name, auto& array) { file.own(fmt::format("pages/{}", name), array); });
        if (ranks_) { ranks_->transfer(file); }
        if (file.loads()) { resume_lists(); }
        if (sleep_)
        {
            transfer_points(file, sleep_->points(), "asleep");
            if (file.loads()) { restore_lasting(sleep_->points(), built); }
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
            for (int c = 0; c < components && !lasts(name); ++c)
            {
                file.plane(exec_, fmt::format("{}/{}_{}", folder, name, c), field.data() + c * points.stride, rows);
            }
        });
}

/// By the ids, which are places in what was built.
template<class Exec, class Real>
void Sand<Exec, Real>::restore_lasting(mpm::Points<Exec, Real>& points, const HostPoints& built)
{
    const std::vector<std::uint32_t> id      = points.id.to_host();
    const auto                       count   = static_cast<std::size_t>(points.count);
    const auto                       restore = [&](auto& field, int component, const auto& value)
    {
        std::vector<std::decay_t<decltype(*field.data())>> plane(count);
        for (std::size_t i = 0; i < count; ++i)
        {
            plane[i] = static_cast<std::decay_t<decltype(*field.data())>>(value(id[i]));
        }
        copy_from_host(exec_, field.data() + component * points.stride, plane.data(), count * sizeof(plane[0]));
    };
    for (int c = 0; c < 3; ++c)
    {
        restore(points.start, c, [&](std::uint32_t i) { return built.position[i][c]; });
    }
    restore(points.mass, 0, [&](std::uint32_t i) { return built.mass[i]; });
    restore(points.volume, 0, [&](std::uint32_t i) { return built.volume[i]; });
    restore(points.material, 0, [&](std::uint32_t i) { return built.material[i]; });
}

template<class Exec, class Real>
void Sand<Exec, Real>::resume_lists()
{
    if (ranks_) { ranks_->resume(pages_, walls_); }
    make_room();
    stirred_in_.fill_zero();
}

template void Sand<Cpu, float>::transfer(StateFile&, const HostPoints&);
template void Sand<Cpu, double>::transfer(StateFile&, const HostPoints&);
#ifdef TREAD_WITH_CUDA
template void Sand<Gpu, float>::transfer(StateFile&, const HostPoints&);
template void Sand<Gpu, double>::transfer(StateFile&, const HostPoints&);
#endif

} // namespace tread::solver
