#pragma once

#include "backend/async_readback.hpp"
#include "io/snapshot.hpp"
#include "kernels/mpm/points.hpp"

namespace tread::solver
{

/// Copy of the point fields that a snapshot shows, in host memory that is reused between snapshots and pinned for a
/// GPU: 93 bytes a point in single precision, 101 for granular materials. Another thread may read it.
template<class Exec, class Real>
class PointCopy
{
public:
    explicit PointCopy(const Exec& exec);

    /// Copies this rank's points, one part after the other, in memory order; synchronises. rows() computes
    /// displacement and Cauchy stress from it.
    void take(const Exec& exec, const std::vector<const mpm::Points<Exec, Real>*>& parts);

    io::PointFields rows() const;

private:
    using Host = HostSide<Exec>;

    /// Position of a part of the points in these planes, and the stride in its own.
    struct Part
    {
        std::int64_t first;
        std::int64_t count;
        std::int64_t stride;
    };

    template<class T>
    void fetch(const Exec& exec, Array<Host, T>& to, const Array<Exec, T>& from, int components, const Part& part);

    Counters                   host_; ///< counters of the host's memory: on a GPU this copy is not device memory
    std::int64_t               count_ = 0;
    Array<Host, double>        position_;
    Array<Host, double>        start_;
    Array<Host, Real>          velocity_;
    Array<Host, Real>          stress_;
    Array<Host, Real>          volume_ratio_;
    Array<Host, Real>          plastic_shear_;
    Array<Host, Real>          plastic_rate_;
    Array<Host, std::uint32_t> id_;
    Array<Host, std::uint8_t>  material_;
};

} // namespace tread::solver
