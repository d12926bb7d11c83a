#pragma once

#include "kernels/dem/sleep/sleeping_bodies.hpp"
#include "kernels/dem/templates.hpp"
#include "kernels/mpm/pages/page_lattice.hpp"

// Which sand a body may touch, where sand and bodies sleep together.
namespace tread::contact
{

/// Keys of pages, ascending.
struct PageKeys
{
    std::int64_t         count;
    const std::uint64_t* key;
};

/// Pages of sand.
struct SandPages
{
    mpm::PageLattice    lattice;
    PageKeys            listed;
    const std::int32_t* first_point; ///< [listed.count + 1], the awake points of each listed page
    PageKeys            asleep;
};

/// Sets bed[bodies] to the dem::SandBed of each body: all pages within `reach` (m) of its bounding sphere count.
template<class Exec>
void find_beds(const Exec&, const dem::BodiesView& bodies, const dem::TemplateView* templates, const SandPages& pages,
               double reach, std::int32_t* bed);

} // namespace tread::contact
