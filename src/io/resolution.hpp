#pragma once

#include <string>
#include <vector>

namespace tread::io
{

/// Verdict on how far a run can be trusted.
enum class Verdict
{
    resolved,
    marginal,
    under_resolved
};

const char* name_of(Verdict verdict);

/// One measure of resolution, with the bounds of docs/verdict.md. Larger is better if the bound `resolved` is the
/// larger one.
struct Figure
{
    std::string name;
    double      value;
    double      resolved; ///< resolved if at least as good as this
    double      marginal; ///< else marginal if at least as good as this

    Verdict verdict() const;
};

/// Worst verdict of the figures; resolved if there are none.
Verdict verdict_of(const std::vector<Figure>& figures);

/// Lists each figure that is not resolved with its bounds, separated by semicolons; empty if all are resolved.
std::string coarse_figures(const std::vector<Figure>& figures);

/// Log line: the verdict, and each figure that is not resolved.
std::string verdict_line(const std::vector<Figure>& figures);

} // namespace tread::io
