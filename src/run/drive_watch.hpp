#pragma once

#include <algorithm>

namespace tread::run
{

/// Decides when the positions of driven bodies are read next: not before one of them can have travelled the distance
/// left to the nearest limit. Reading a position synchronises the device and is a collective call.
class DriveWatch
{
public:
    /// Records the largest speed (m/s) of the bodies when it is measured, at `time` (s).
    void note_speed(double time, double speed)
    {
        const double span = time - time_;
        left_ -= reserve * std::max(speed, speed_) * span;
        time_  = time;
        speed_ = speed;
    }

    bool is_due() const { return !(left_ > 0); }

    /// Records the distance (m) to the nearest limit.
    void set_distance_left(double left) { left_ = left; }

    /// Makes a reading due: a new phase has other limits.
    void reset() { left_ = 0; }

private:
    static constexpr double reserve = 2; ///< factor: bodies may be faster between two measurements than at both

    double left_  = 0; ///< m
    double time_  = 0; ///< s
    double speed_ = 0; ///< m/s
};

} // namespace tread::run
