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
    return keeps(marginal) ? Verdict::marginal : Verdict::under_resolved; // what is not a number keeps no bound
}

Verdict verdict_of(const std::vector<Figure>& figures)
{
    Verdict worst = Verdict::resolved;
    for (const Figure& figure : figures) { worst = std::max(worst, figure.verdict()); }
    return worst;
}

std::string verdict_line(const std::vector<Figure>& figures)
{
    std::string line = name_of(verdict_of(figures));
    for (const Figure& figure : figures)
    {
        if (figure.verdict() == Verdict::resolved) { continue; }
        line += fmt::format("{} {} {:.3g} (resolved {} {:.3g}, marginal {} {:.3g})",
                            line.find(':') == std::string::npos ? ":" : ";", figure.name, figure.value,
                            figure.resolved > figure.marginal ? "from" : "to", figure.resolved,
                            figure.resolved > figure.marginal ? "from" : "to", figure.marginal);
    }
    return line;
}

} // namespace tread::io
