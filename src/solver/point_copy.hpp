#pragma once

#include "backend/async_readback.hpp"
#include "io/snapshot.hpp"
#include "kernels/mpm/points.hpp"

namespace tread::solver
{

/// What a snapshot shows of the points, as it was when it was taken: planes in host memory that is kept from one
/// snapshot to the next, and on a GPU is pinned: 93 bytes a point in single precision, 101 of granular ones. Another
/// thread may read it.
template<class Exec, class Real>
class PointCopy
{
public:
    explicit PointCopy(const Exec& exec);

    /// Of this rank's points, one part after the other, in memory order; waits for it. Displacement and Cauchy stress
    /// are made of it in rows().
    void take(const Exec& exec, const std::vector<const mpm::Points<Exec, Real>*>& parts);

    io::PointFields rows() const;

private:
    using Host = decltype(host_side(std::declval<Exec>()));

    /// Where a part of the points stands in the planes here, and in its own.
    struct Part
    {
        std::int64_t first;
        std::int64_t count;
        std::int64_t stride;
    };

    template<class T>
    void fetch(const Exec& exec, Array<Host, T>& to, const Array<Exec, T>& from, int components, const Part& part);

    Counters                   host_; ///< on a GPU: what is here is none of the device's memory
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
