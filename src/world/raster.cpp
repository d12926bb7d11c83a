#include "world/raster.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <string_view>

#include <fmt/format.h>

#include "base/bytes_text.hpp"
#include "base/errors.hpp"
#include "base/host_memory.hpp"
#include "base/saturated.hpp"

namespace tread::world
{
namespace
{

constexpr std::size_t most_samples = 100'000'000;

/// Reads the bytes of a file; they and the samples (at most one for two bytes) must fit into memory.
std::string contents(const std::string& path)
{
    constexpr double most = 1e9, with_samples = 1 + 0.5 * sizeof(double);
    std::error_code  error;
    const auto       bytes = static_cast<double>(std::filesystem::file_size(path, error));
    if (error) { throw InputError(fmt::format("{}: cannot be read: {}", path, error.message())); }
    if (bytes > most)
    {
        throw InputError(fmt::format("{}: a file of {}; accepted: at most {}", path, bytes_text(saturated(bytes)),
                                     bytes_text(saturated(most))));
    }
    require_host_memory({with_samples * bytes, fmt::format("{}: its samples", path), "a file of fewer samples"});
    std::ifstream stream(path, std::ios::binary);
    std::string   text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
    if (!stream) { throw InputError(fmt::format("{}: cannot be read", path)); }
    return text;
}

/// A PGM's bytes and the read position.
class PictureText
{
public:
    PictureText(std::string path, std::string bytes)
        : path_(std::move(path))
        , bytes_(std::move(bytes))
    {
    }

    [[noreturn]] void refuse(const std::string& what) const
    {
        const auto line = 1 + std::count(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(at_), '\n');
        throw InputError(fmt::format("{}:{}: {}", path_, line, what));
    }

    /// Reads the next decimal number, after blanks and comments.
    std::size_t number(const std::string& of, std::size_t low, std::size_t high)
    {
        skip_blanks();
        std::size_t value        = 0;
        const auto* end          = bytes_.data() + bytes_.size();
        const auto [rest, error] = std::from_chars(bytes_.data() + at_, end, value);
        if (at_ == bytes_.size()) { refuse(fmt::format("the file ends before the {}", of)); }
        if (error != std::errc() || value < low || value > high)
        {
            refuse(fmt::format("no {} here; accepted: integer {} to {}", of, low, high));
        }
        at_ = static_cast<std::size_t>(rest - bytes_.data());
        return value;
    }

    std::string_view word(std::size_t length)
    {
        const auto text = std::string_view(bytes_).substr(at_, length);
        at_ += text.size();
        return text;
    }

    std::size_t left() const { return bytes_.size() - at_; }

private:
    void skip_blanks()
    {
        while (at_ < bytes_.size())
        {
            if (bytes_[at_] == '#') { at_ = std::min(bytes_.find('\n', at_), bytes_.size()); }
            else if (std::string_view(" \t\r\n\v\f").find(bytes_[at_]) != std::string_view::npos) { ++at_; }
            else { return; }
        }
    }

    std::string path_;
    std::string bytes_;
    std::size_t at_ = 0;
};

void require_sizes(const std::string& path, std::size_t columns, std::size_t rows)
{
    if (columns < 2 || rows < 2 || columns > most_samples / rows)
    {
        throw InputError(fmt::format("{}: {} x {} samples; accepted: at least 2 x 2, at most {} in all", path, columns,
                                     rows, most_samples));
    }
}

/// Reads Netpbm's PGM: plain (P2) or raw (P5); two bytes a sample, high one first, where the largest value is over
/// 255.
Raster read_picture(const scene::RasterFile& file)
{
    PictureText text(file.path, contents(file.path));
    const auto  magic = text.word(2);
    const bool  raw   = magic == "P5";
    if (!raw && magic != "P2") { text.refuse("no PGM; accepted: a file that begins with P2 or P5"); }
    Raster raster;
    raster.columns   = text.number("width", 2, most_samples);
    raster.rows      = text.number("height", 2, most_samples);
    const auto white = text.number("largest grey value", 1, 65535);
    require_sizes(file.path, raster.columns, raster.rows);
    const std::size_t samples = raster.columns * raster.rows, bytes = white > 255 ? 2 : 1;
    if (raw)
    {
        text.word(1);
        if (text.left() < samples * bytes)
        {
            text.refuse(fmt::format("the file is cut short: {} of {} bytes of samples", text.left(), samples * bytes));
        }
    }
    else if (text.left() < samples) { text.refuse("the file is cut short: fewer samples than its header says"); }
    raster.heights.reserve(samples);
    for (std::size_t i = 0; i < samples; ++i)
    {
        std::size_t grey = 0;
        if (raw)
        {
            for (const char byte : text.word(bytes)) { grey = 256 * grey + static_cast<unsigned char>(byte); }
            if (grey > white) { text.refuse(fmt::format("sample {} is {}; accepted: 0 to {}", i, grey, white)); }
        }
        else { grey = text.number("sample", 0, white); }
        raster.heights.push_back(file.low +
                                 (file.high - file.low) * static_cast<double>(grey) / static_cast<double>(white));
    }
    return raster;
}

std::string_view trimmed(std::string_view text)
{
    const auto first = text.find_first_not_of(" \t\r");
    if (first == std::string_view::npos) { return {}; }
    return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::vector<double> read_row(std::string_view line, double unit, const std::string& where)
{
    std::vector<double> heights;
    for (std::size_t from = 0; from <= line.size();)
    {
        const auto to            = std::min(line.find(',', from), line.size());
        const auto field         = trimmed(line.substr(from, to - from));
        double     value         = 0;
        const auto [rest, error] = std::from_chars(field.data(), field.data() + field.size(), value);
        if (error != std::errc() || rest != field.data() + field.size() || !std::isfinite(value))
        {
            throw InputError(
                fmt::format("{}: \"{}\" in column {}; accepted: finite number", where, field, heights.size() + 1));
        }
        heights.push_back(unit * value);
        from = to + 1;
    }
    return heights;
}

Raster read_numbers(const scene::RasterFile& file)
{
    const std::string      text = contents(file.path);
    const std::string_view all  = text;
    Raster                 raster;
    std::size_t            number = 0;
    for (std::size_t from = 0; from < all.size();)
    {
        const auto to   = std::min(all.find('\n', from), all.size());
        const auto line = trimmed(all.substr(from, to - from));
        from            = to + 1;
        ++number;
        if (line.empty() || line.front() == '#') { continue; }
        const auto where   = fmt::format("{}:{}", file.path, number);
        const auto heights = read_row(line, file.unit, where);
        if (raster.rows == 0) { raster.columns = heights.size(); }
        if (heights.size() != raster.columns)
        {
            throw InputError(fmt::format("{}: {} numbers; accepted: {}, as in the first row", where, heights.size(),
                                         raster.columns));
        }
        raster.heights.insert(raster.heights.end(), heights.begin(), heights.end());
        ++raster.rows;
        if (raster.heights.size() > most_samples) { require_sizes(file.path, raster.columns, raster.rows); }
    }
    require_sizes(file.path, raster.columns, std::max<std::size_t>(raster.rows, 1));
    return raster;
}

/// Cell of a lattice of `samples` that contains `at` in [0, 1], and the relative position in it.
struct Place
{
    std::size_t cell;
    double      share;
};

Place place_of(double at, std::size_t samples)
{
    const double scaled = std::clamp(at, 0.0, 1.0) * static_cast<double>(samples - 1);
    const auto   cell   = std::min(static_cast<std::size_t>(scaled), samples - 2);
    return {cell, scaled - static_cast<double>(cell)};
}

} // namespace

Raster read_raster(const scene::RasterFile& file)
{
    const bool picture = file.path.size() > 4 && file.path.compare(file.path.size() - 4, 4, ".pgm") == 0;
    return picture ? read_picture(file) : read_numbers(file);
}

double bilinear(const Raster& raster, const scene::PlanExtent& extent, double x, double y)
{
    constexpr double rounding = 1e-9;
    const double     u        = (x - extent[0][0]) / (extent[1][0] - extent[0][0]),
                 v            = (extent[1][1] - y) / (extent[1][1] - extent[0][1]);
    if (std::min(u, v) < -rounding || std::max(u, v) > 1 + rounding)
    {
        return std::numeric_limits<double>::quiet_NaN();
    }
    const Place column = place_of(u, raster.columns), row = place_of(v, raster.rows);
    const auto  height = [&](std::size_t i, std::size_t j)
    { return raster.heights[(row.cell + j) * raster.columns + column.cell + i]; };
    const auto along_x = [&](std::size_t j) { return (1 - column.share) * height(0, j) + column.share * height(1, j); };
    return (1 - row.share) * along_x(0) + row.share * along_x(1);
}

} // namespace tread::world
