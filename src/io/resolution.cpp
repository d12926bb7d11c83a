#include "io/resolution.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace tread::io
{

const char* name_of(Verdict verdict)
{
    switch (verdict)
    {
    case Verdict::resolved:
        return "resolved";
    case Verdict::marginal:
        return "marginal";
    case Verdict::under_resolved:
        break;
    }
    return "under-resolved";
}

Verdict Figure::verdict() const
{
    const auto keeps = [&](double bound) { return resolved > marginal ? value >= bound : value <= bound; };
    if (keeps(resolved)) { return Verdict::resolved; }
    return keeps(marginal) ? Verdict::marginal : Verdict::under_resolved; // NaN satisfies no bound
}

Verdict verdict_of(const std::vector<Figure>& figures)
{
    Verdict worst = Verdict::resolved;
    for (const Figure& figure : figures) { worst = std::max(worst, figure.verdict()); }
    return worst;
}

std::string coarse_figures(const std::vector<Figure>& figures)
{
    std::string text;
    for (const Figure& figure : figures)
    {
        if (figure.verdict() == Verdict::resolved) { continue; }
        const char* side = figure.resolved > figure.marginal ? "from" : "to";
        text += fmt::format("{}{} {:.3g} (resolved {} {:.3g}, marginal {} {:.3g})", text.empty() ? "" : "; ",
                            figure.name, figure.value, side, figure.resolved, side, figure.marginal);
    }
    return text;
}

std::string verdict_line(const std::vector<Figure>& figures)
{
    const std::string coarse = coarse_figures(figures);
    return name_of(verdict_of(figures)) + (coarse.empty() ? "" : ": " + coarse);
}

} // namespace tread::io
