#include "solver/stage_clock.hpp"

#include <algorithm>
#include <sstream>

#include "solver/state_file.hpp"

namespace tread::solver
{
namespace
{

constexpr double most_calls = 9007199254740992.0; // 2^53: doubles hold them exactly

} // namespace

void StageClock::transfer(StateFile& file)
{
    std::string         names;
    std::vector<double> values;
    for (const auto& [name, row] : rows_)
    {
        names += name + "\n";
        const auto calls = static_cast<double>(row.all_calls());
        values.insert(values.end(), {calls, calls, row.all_seconds()});
    }
    file.text("stages", names);
    const auto lines = static_cast<std::size_t>(std::count(names.begin(), names.end(), '\n'));
    file.common("stages", values, accept::all(accept::rows(3 * lines), accept::within(0, most_calls)));
    if (!file.loads()) { return; }
    std::istringstream each_name(names);
    auto               value = values.begin();
    for (std::string name; std::getline(each_name, name) && value != values.end(); value += 3)
    {
        rows_[name]        = {};
        rows_[name].before = {static_cast<std::int64_t>(value[0]), static_cast<std::int64_t>(value[1]), value[2]};
    }
}

std::vector<io::StageReport> StageClock::reports(const std::vector<Stage>& stages) const
{
    std::vector<io::StageReport> reports;
    for (const Stage& stage : stages)
    {
        io::StageReport report{stage.name, stage.on, stage.on ? "" : stage.why, 0, 0};
        const auto      at = rows_.find(stage.name);
        if (at == rows_.end())
        {
            if (!stage.on) { reports.push_back(report); } // stages that are on are timed within another stage
            continue;
        }
        report.calls   = at->second.all_calls();
        report.seconds = at->second.all_seconds();
        reports.push_back(report);
    }
    return reports;
}

} // namespace tread::solver
