#include <cmath>

#include "base/errors.hpp"
#include "physics/harness.hpp"

// Stable, or stopped with a diagnosis: never silently wrong.
namespace
{

using namespace tread;

const std::string impact_text = R"(
title = "a block of sand lands on the floor"
[domain]
size    = [0.4, 0.4, 0.6]
gravity = [0.0, 0.0, -9.81]
[grid]
spacing = 0.05
[time]
dt = DT
[[material]]
name = "sand"
model = "mohr-coulomb"
density = 1600.0
young = YOUNG
poisson = 0.3
friction_angle_deg = 30.0
[[terrain]]
material = "sand"
region = { box = [[0.1, 0.1, 0.1], [0.3, 0.3, 0.4]] }
[[phase]]
name = "fall"
duration = DURATION
)";

std::string filled(std::string text, const std::string& word, const std::string& value)
{
    return text.replace(text.find(word), word.size(), value);
}

enum class Outcome
{
    stable,
    stopped,
    wrong
};

/// Wrong = the energy that is there grows past twice what the fall can give, and nobody stopped it.
template<class Exec>
Outcome outcome(const Exec& exec, const std::string& dt, double young, double duration)
{
    const std::string text = filled(filled(filled(impact_text, "DT", dt), "YOUNG", std::to_string(young)), "DURATION",
                                    std::to_string(duration));
    test::Experiment<Exec, float> impact(exec, text);
    const solver::Census          start    = impact.simulation().census();
    const double                  exchange = start.sand.strain + 9.81 * start.sand.moment[2];
    bool                          wrong    = false;
    std::int64_t                  steps    = 0;
    try
    {
        impact.run(
            [&](double)
            {
                if (++steps % 20 != 0) { return; }
                const solver::Census now = impact.simulation().census();
                wrong                    = wrong || !(now.sand.kinetic + now.sand.strain < 2 * exchange);
            });
    }
    catch (const NumericalError& error)
    {
        std::cout << "[ stability] stopped after " << steps << " steps: " << error.what() << '\n';
        return Outcome::stopped;
    }
    return wrong ? Outcome::wrong : Outcome::stable;
}

template<class Exec>
class SandStep : public test::BackendTest<Exec>
{
};
TYPED_TEST_SUITE(SandStep, test::Backends, test::BackendNames);

TYPED_TEST(SandStep, StableUpToTheAutomaticLimit)
{
    // Courant 0.6 of c_p = 29.0 m/s at h = 0.05 m: 1.034e-3 s.
    for (const char* dt : {"5.2e-4", "9.3e-4", "\"auto\""})
    {
        EXPECT_EQ(outcome(this->exec(), dt, 1e6, 0.5), Outcome::stable) << "dt = " << dt;
    }
}

TYPED_TEST(SandStep, StiffAndSoftSandAreStableAtTheAutomaticStep)
{
    for (const auto& [young, duration] : {std::pair{1e4, 0.5}, {1e6, 0.5}, {1e8, 0.2}, {1e10, 0.02}})
    {
        EXPECT_EQ(outcome(this->exec(), "\"auto\"", young, duration), Outcome::stable) << "E = " << young;
    }
}

} // namespace
