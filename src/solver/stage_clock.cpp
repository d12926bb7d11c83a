#include "solver/stage_clock.hpp"

namespace tread::solver
{

std::vector<io::StageReport> StageClock::reports(const std::vector<Stage>& stages) const
{
    std::vector<io::StageReport> reports;
    for (const Stage& stage : stages)
    {
        io::StageReport report{stage.name, stage.on, stage.on ? "" : stage.why, 0, 0};
        const auto      at = rows_.find(stage.name);
        if (at == rows_.end())
        {
            if (!stage.on) { reports.push_back(report); } // the others are timed within another stage
            continue;
        }
        const Row& row = at->second;
        report.calls   = row.calls;
        report.seconds =
            row.timed > 0 ? row.seconds * static_cast<double>(row.calls) / static_cast<double>(row.timed) : 0;
        reports.push_back(report);
    }
    return reports;
}

} // namespace tread::solver
