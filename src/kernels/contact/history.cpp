#include "backend/launch.hpp"
#include "kernels/contact/history_impl.hpp"

namespace tread::contact
{

template void                       resize(History<Cpu>&, std::int64_t);
template void                       extend(History<Cpu>&, std::int64_t);
template void                       fill_bins(const Cpu&, History<Cpu>&);
template std::vector<HistoryRecord> read_out(const History<Cpu>&);
template void                       put_back(const Cpu&, History<Cpu>&, const std::vector<HistoryRecord>&);
template void                       add_records(const Cpu&, History<Cpu>&, const std::vector<HistoryRecord>&);
template std::vector<HistoryRecord> records_of(const Cpu&, const History<Cpu>&, const std::vector<std::uint32_t>&);

} // namespace tread::contact
