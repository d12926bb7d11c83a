#pragma once

#include <string>
#include <utility>
#include <vector>

#include "run/plausibility.hpp"
#include "scene/lines.hpp"

namespace tread::run
{

/// Collects the warnings of a scene.
class Warnings
{
public:
    explicit Warnings(const scene::Scene& scene)
        : scene_(scene)
    {
    }

    /// `table`: name for scene::line_of.
    void add(const std::string& table, std::string text)
    {
        std::string where = scene::line_of(scene_, table);
        if (!where.empty()) { where.resize(where.size() - 2); } // the colon and the blank
        all_.push_back({std::move(where), std::move(text)});
    }

    std::vector<Warning> take() { return std::move(all_); }

private:
    const scene::Scene&  scene_;
    std::vector<Warning> all_;
};

} // namespace tread::run
