#include "backend/launch.cuh"
#include "kernels/contact/history_impl.hpp"

namespace tread::contact
{

template void                       resize(History<Gpu>&, std::int64_t);
template void                       extend(History<Gpu>&, std::int64_t);
template void                       fill_bins(const Gpu&, History<Gpu>&);
template std::vector<HistoryRecord> read_out(const History<Gpu>&);
template void                       put_back(const Gpu&, History<Gpu>&, const std::vector<HistoryRecord>&);
template void                       add_records(const Gpu&, History<Gpu>&, const std::vector<HistoryRecord>&);
template std::vector<HistoryRecord> records_of(const Gpu&, const History<Gpu>&, const std::vector<std::uint32_t>&);

} // namespace tread::contact
