#pragma once

#include "backend/instantiate.hpp"
#include "backend/sort.hpp"
#include "kernels/contact/beds.hpp"
#include "kernels/dem/pairs/displacement_kern.hpp"

// Steps of beds.hpp, for both backends; beds.cpp and beds.cu provide for_each.
namespace tread::contact
{
namespace bed_steps
{

TREAD_HD bool sleeps_in(const SandPages& pages, std::uint64_t page)
{
    return find_sorted(pages.asleep.key, pages.asleep.count, page) >= 0;
}

TREAD_HD bool is_awake_in(const SandPages& pages, std::uint64_t page)
{
    const std::int64_t at = find_sorted(pages.listed.key, pages.listed.count, page);
    return at >= 0 && pages.first_point[at] < pages.first_point[at + 1];
}

struct FindBed
{
    dem::BodiesView          bodies;
    const dem::TemplateView* templates;
    SandPages                pages;
    double                   reach; ///< m
    std::int32_t*            bed;

    TREAD_HD void operator()(std::int64_t b) const
    {
        const double       radius = dem::bounding_radius(bodies, templates, b) + reach;
        const Vec3<double> around = Vec3<double>::Constant(radius);
        const mpm::Index3  low    = mpm::page_at(pages.lattice, bodies.position[b] - around);
        const mpm::Index3  high   = mpm::page_at(pages.lattice, bodies.position[b] + around);
        bool               any = false, sleeps = false;
        for (std::int32_t z = low.z; z <= high.z; ++z)
        {
            for (std::int32_t y = low.y; y <= high.y; ++y)
            {
                for (std::int32_t x = low.x; x <= high.x; ++x)
                {
                    const std::uint64_t key = mpm::page_key({x, y, z});
                    sleeps                  = sleeps || sleeps_in(pages, key);
                    any                     = any || sleeps || is_awake_in(pages, key);
                }
            }
        }
        bed[b] = sleeps ? dem::bed_asleep : any ? dem::bed_awake : dem::bed_none;
    }
};

} // namespace bed_steps

template<class Exec>
void find_beds(const Exec& exec, const dem::BodiesView& bodies, const dem::TemplateView* templates,
               const SandPages& pages, double reach, std::int32_t* bed)
{
    for_each(exec, "find beds", bodies.count, bed_steps::FindBed{bodies, templates, pages, reach, bed});
}

#define TREAD_INSTANTIATE(Exec)                                                                                        \
    template void find_beds(const Exec&, const dem::BodiesView&, const dem::TemplateView*, const SandPages&, double,   \
                            std::int32_t*)
TREAD_FOR_THIS_BACKEND(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::contact
