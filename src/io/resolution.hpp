#pragma once

#include <string>
#include <vector>

namespace tread::io
{

/// How far a run can be trusted.
enum class Verdict
{
    resolved,
    marginal,
    under_resolved
};

const char* name_of(Verdict verdict);

/// A figure that tells one side of it, with the bounds of docs/verdict.md. Where the bound for `resolved` is the larger
/// one, more is better.
struct Figure
{
    std::string name;
    double      value;
    double      resolved; ///< as good as this, or better: resolved
    double      marginal; ///< else as good as this, or better: marginal

    Verdict verdict() const;
};

/// The worst of them; resolved if there are none.
Verdict verdict_of(const std::vector<Figure>& figures);

/// Each figure that is not resolved with its bounds, separated by semicolons; empty if all are resolved.
std::string coarse_figures(const std::vector<Figure>& figures);

/// For the log: the verdict of the figures, and each figure that is not resolved.
std::string verdict_line(const std::vector<Figure>& figures);

} // namespace tread::io
