#pragma once

#include "backend/instantiate.hpp"
#include "kernels/dem/pairs/pairs_kern.hpp"
#include "kernels/dem/pairs/records.hpp"
#include "kernels/dem/pairs/records_kern.hpp"
#include "kernels/dem/pairs/select.hpp"

// Steps of records.hpp, for both backends; records.cpp and records.cu provide for_each.
namespace tread::dem::record_steps
{

/// Whether a record leaves with the body whose owner evaluates it.
struct Leaves
{
    std::int64_t         bodies;
    const std::uint64_t* key;
    const std::int32_t*  is_large;
    const std::int32_t*  leaving;

    TREAD_HD bool operator()(std::int64_t p) const
    {
        const std::int64_t a = first_of(key[p]), b = second_of(key[p]);
        return leaving[b < bodies ? decider_of(is_large, a, b) : a] >= 0;
    }
};

struct Stays
{
    Leaves leaves;

    TREAD_HD bool operator()(std::int64_t p) const { return !leaves(p); }
};

struct RecordsView
{
    const std::uint64_t* key;
    const Patch*         patch;
    const Rolling*       rolling; ///< null: none
    const Vec3<double>*  place;   ///< null: none
};

template<class T>
const T* data_or_null(std::int64_t size, const T* data)
{
    return size > 0 ? data : nullptr;
}

template<class Exec>
RecordsView present(const Pairs<Exec>& pairs)
{
    return {pairs.last.key.data(), pairs.last.patch.data(),
            data_or_null(pairs.last.rolling.size(), pairs.last.rolling.data()),
            data_or_null(pairs.patches.last_place.size(), pairs.patches.last_place.data())};
}

template<class Exec>
RecordsView view_of(const RecordRows<Exec>& rows)
{
    return {rows.key.data(), rows.patch.data(), data_or_null(rows.rolling.size(), rows.rolling.data()),
            data_or_null(rows.place.size(), rows.place.data())};
}

/// Row i of the result is row origin[i] of the first records, or row ~origin[i] of the second ones.
struct TakeRow
{
    RecordsView         first;
    RecordsView         second;
    const std::int32_t* origin;
    std::uint64_t*      key;
    Patch*              patch;
    Rolling*            rolling; ///< null: none
    Vec3<double>*       place;   ///< null: none

    TREAD_HD void operator()(std::int64_t i) const
    {
        const RecordsView& from = origin[i] >= 0 ? first : second;
        const std::int64_t row  = origin[i] >= 0 ? origin[i] : ~origin[i];
        key[i]                  = from.key[row];
        patch[i]                = from.patch[row];
        if (rolling != nullptr) { rolling[i] = from.rolling[row]; }
        if (place != nullptr)
        {
            place[i] = from.place != nullptr ? from.place[row] : Vec3<double>(Vec3<double>::Zero());
        }
    }
};

template<class Exec>
RecordRows<Exec> take_rows(const Exec& exec, const RecordsView& first, const RecordsView& second,
                           const Array<Exec, std::int32_t>& origin)
{
    RecordRows<Exec>   rows(exec);
    const std::int64_t count = origin.size();
    const bool         rolls = first.rolling != nullptr || second.rolling != nullptr,
               has_places    = first.place != nullptr || second.place != nullptr;
    rows.key.resize(count);
    rows.patch.resize(count);
    rows.rolling.resize(rolls ? count : 0);
    rows.place.resize(has_places ? count : 0);
    for_each(exec, "take records", count,
             TakeRow{first, second, origin.data(), rows.key.data(), rows.patch.data(),
                     rolls ? rows.rolling.data() : nullptr, has_places ? rows.place.data() : nullptr});
    return rows;
}

template<class Exec>
void put_back(RecordRows<Exec>& rows, Pairs<Exec>& pairs)
{
    pairs.last.key.swap(rows.key);
    pairs.last.patch.swap(rows.patch);
    pairs.last.rolling.swap(rows.rolling);
    pairs.patches.last_place.swap(rows.place);
}

struct WriteOrigin
{
    std::int64_t         present;
    const std::uint64_t* key;
    const std::uint64_t* arriving;
    std::uint64_t*       keys;
    std::int32_t*        origin;

    TREAD_HD void operator()(std::int64_t i) const
    {
        keys[i]   = i < present ? key[i] : arriving[i - present];
        origin[i] = static_cast<std::int32_t>(i < present ? i : ~(i - present));
    }
};

} // namespace tread::dem::record_steps

namespace tread::dem
{

template<class Exec>
RecordRows<Exec> take_records(const Exec& exec, Pairs<Exec>& pairs, const Array<Exec, std::int32_t>& leaving)
{
    using namespace record_steps;
    const std::int64_t records = pairs.last.key.size();
    const Leaves       leaves{leaving.size(), pairs.last.key.data(), pairs.sizes.is_large.data(), leaving.data()};
    Array<Exec, std::int32_t> chosen(exec, "chosen records");
    select(exec, "records that leave", records, leaves, pairs.search.found, pairs.sort, chosen);
    RecordRows<Exec> taken = take_rows(exec, present(pairs), present(pairs), chosen);
    if (taken.key.size() == 0) { return taken; }
    select(exec, "records that stay", records, Stays{leaves}, pairs.search.found, pairs.sort, chosen);
    RecordRows<Exec> kept = take_rows(exec, present(pairs), present(pairs), chosen);
    put_back(kept, pairs);
    return taken;
}

template<class Exec>
void add_records(const Exec& exec, Pairs<Exec>& pairs, const RecordRows<Exec>& arriving)
{
    using namespace record_steps;
    if (arriving.key.size() == 0) { return; }
    const std::int64_t         present_count = pairs.last.key.size(), count = present_count + arriving.key.size();
    Array<Exec, std::uint64_t> key(exec, "keys of merged records", count);
    Array<Exec, std::int32_t>  origin(exec, "origins of merged records", count);
    for_each(exec, "merge records", count,
             WriteOrigin{present_count, pairs.last.key.data(), arriving.key.data(), key.data(), origin.data()});
    sort_by_key(exec, key, origin, pairs.sort);
    RecordRows<Exec> merged = take_rows(exec, present(pairs), view_of(arriving), origin);
    put_back(merged, pairs);
}

template<class Exec>
void renumber_records(const Exec& exec, Pairs<Exec>& pairs, const Array<Exec, std::int32_t>& row, std::int64_t rows)
{
    using namespace record_steps;
    const NewRows             now{row.size(), rows, row.data()};
    Array<Exec, std::int32_t> left(exec, "records left");
    const std::int64_t        records = pairs.last.key.size();
    select(exec, "records left", records, IsLeft{now, pairs.last.key.data()}, pairs.search.found, pairs.sort, left);
    if (left.size() < records)
    {
        RecordRows<Exec> kept = take_rows(exec, present(pairs), present(pairs), left);
        put_back(kept, pairs);
    }
    for_each(exec, "renumber records", left.size(), Renumber{now, pairs.last.key.data()});
}

#define TREAD_INSTANTIATE(Exec)                                                                                        \
    template RecordRows<Exec> take_records(const Exec&, Pairs<Exec>&, const Array<Exec, std::int32_t>&);               \
    template void             add_records(const Exec&, Pairs<Exec>&, const RecordRows<Exec>&);                         \
    template void renumber_records(const Exec&, Pairs<Exec>&, const Array<Exec, std::int32_t>&, std::int64_t)
TREAD_FOR_THIS_BACKEND(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::dem
