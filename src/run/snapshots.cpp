#include "run/snapshots.hpp"
#include "backend/instantiate.hpp"

#include <chrono>
#include <utility>

namespace tread::run
{

template<class Exec, class Real>
Snapshots<Exec, Real>::Snapshots(const Communicator& communicator, const Exec& exec, io::SnapshotWriter files)
    : alone_(communicator.size() == 1)
    , points_(exec)
    , files_(std::move(files))
{
}

template<class Exec, class Real>
void Snapshots<Exec, Real>::write(double time, solver::Simulation<Exec, Real>& simulation)
{
    finish();
    simulation.copy_points(points_);
    bodies_ = simulation.body_fields();

    const auto to_files = [this, time] { files_.write(time, points_.rows(), bodies_); };
    if (alone_) { under_way_ = std::async(std::launch::async, to_files); }
    else { to_files(); }
}

template<class Exec, class Real>
bool Snapshots<Exec, Real>::writing() const
{
    return under_way_.valid() && under_way_.wait_for(std::chrono::seconds(0)) != std::future_status::ready;
}

template<class Exec, class Real>
void Snapshots<Exec, Real>::finish()
{
    if (under_way_.valid()) { under_way_.get(); }
}

template<class Exec, class Real>
const std::vector<double>& Snapshots<Exec, Real>::times()
{
    finish();
    return files_.times();
}

template<class Exec, class Real>
void Snapshots<Exec, Real>::resume(std::vector<double> times)
{
    files_.resume(std::move(times));
}

#define TREAD_INSTANTIATE(Exec, Real) template class Snapshots<Exec, Real>
TREAD_FOR_BACKENDS_AND_REALS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::run
