#include "solver/coupling.hpp"
#include "solver/state_file.hpp"

// What sand-body contacts remember, into a checkpoint and out of it.
namespace tread::solver
{

template<class Exec, class Real>
void Coupling<Exec, Real>::transfer(StateFile& file, const dem::BodiesView& bodies)
{
    file.numbers("contact/steps", used_, version_, begun_);
    file.numbers("contact/summary", summary_.live, summary_.live_named, summary_.energy, summary_.dissipated,
                 summary_.stiffest.value, summary_.stiffest.body, summary_.stiffest.point_id, summary_.deepest.value,
                 summary_.deepest.body, summary_.deepest.point_id, summary_.flattest.value, summary_.flattest.body,
                 summary_.flattest.point_id);
    std::vector<contact::HistoryRecord> records;
    if (!file.loads()) { records = remembered(); }
    transfer_records(file, records);
    if (file.exact()) { transfer_candidates(file, bodies); }
    if (!file.loads()) { return; }
    if (!file.exact())
    {
        contact_.tangential.resize(0); // the search that follows has the records instead
        version_ = 0;
        begun_   = false;
    }
    if (contact_.tangential.size() == 0) { contact::put_back(exec_, contact_.history, records); }
}

/// Where pairs have their records by them, the table has none.
template<class Exec, class Real>
std::vector<contact::HistoryRecord> Coupling<Exec, Real>::remembered()
{
    if (contact_.tangential.size() == 0) { return contact::read_out(contact_.history); }
    contact::keep_history(exec_, contact_);
    std::vector<contact::HistoryRecord> records = contact::read_out(contact_.history);
    contact::put_back(exec_, contact_.history, {});
    return records;
}

template<class Exec, class Real>
void Coupling<Exec, Real>::transfer_records(StateFile& file, std::vector<contact::HistoryRecord>& records)
{
    std::vector<std::uint64_t>       keys;
    std::vector<contact::Tangential> tangential;
    for (const contact::HistoryRecord& record : records)
    {
        keys.push_back(record.key);
        tangential.push_back(record.tangential);
    }
    file.own_or_all("contact/key", keys);
    file.own_or_all("contact/tangential", tangential);
    records.clear();
    for (std::size_t i = 0; i < keys.size(); ++i) { records.push_back({keys[i], tangential[i]}); }
}

/// Pairs that are listed have a place for what they remember whether they do or not; the search that follows files it
/// under the ids of the points that the last step has copied.
template<class Exec, class Real>
void Coupling<Exec, Real>::transfer_candidates(StateFile& file, const dem::BodiesView& bodies)
{
    file.own("candidates/body", contact_.candidates.body);
    file.own("candidates/point", contact_.candidates.point);
    std::vector<contact::Tangential> tangential = contact_.tangential.to_host();
    std::vector<std::uint32_t>       ids        = contact_.id.to_host();
    file.own("candidates/tangential", tangential);
    file.own("candidates/id", ids);
    if (!file.loads()) { return; }
    contact::resume_candidates(exec_, contact_, bodies, law_);
    contact_.tangential.assign(tangential);
    contact_.id.assign(ids);
}

template void Coupling<Cpu, float>::transfer(StateFile&, const dem::BodiesView&);
template void Coupling<Cpu, double>::transfer(StateFile&, const dem::BodiesView&);
#ifdef TREAD_WITH_CUDA
template void Coupling<Gpu, float>::transfer(StateFile&, const dem::BodiesView&);
template void Coupling<Gpu, double>::transfer(StateFile&, const dem::BodiesView&);
#endif

} // namespace tread::solver
