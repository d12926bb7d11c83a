#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace tread::solver
{

/// Numbers of the bodies that this rank has rows for. A body's number is its place in the scene, the same on all ranks;
/// its row is its place in this rank's arrays. Rows ascend with numbers.
class BodyNumbers
{
public:
    /// Every one of a scene's bodies, in the row of its number.
    explicit BodyNumbers(std::size_t bodies)
        : bodies_(bodies)
    {
    }

    /// `numbers`: of the rows, ascending, below `bodies`.
    BodyNumbers(std::vector<std::int32_t> numbers, std::size_t bodies);

    std::size_t rows() const { return numbers_ ? numbers_->size() : bodies_; }
    std::size_t bodies() const { return bodies_; }

    std::int64_t number(std::int64_t row) const { return numbers_ ? (*numbers_)[static_cast<std::size_t>(row)] : row; }

    /// Row of a body; empty where this rank has none.
    std::optional<std::int32_t> find_row(std::int64_t number) const;

    /// Rows of bodies that have some.
    std::vector<std::int32_t> rows_of(const std::vector<std::int32_t>& numbers) const;

    /// Values of the rows, of those of all bodies.
    template<class T>
    std::vector<T> of_rows(const std::vector<T>& of_bodies) const
    {
        if (!numbers_) { return of_bodies; }
        std::vector<T> values;
        values.reserve(rows());
        for (const std::int32_t number : *numbers_) { values.push_back(of_bodies[static_cast<std::size_t>(number)]); }
        return values;
    }

    /// Key (kernels/dem/pairs/pairs.hpp) of a pair in the scene, where walls follow all bodies. `key`: of rows.
    std::uint64_t key_in_scene(std::uint64_t key) const;

    /// Key of rows; empty where this rank has none for a body of the pair. `key`: of the scene.
    std::optional<std::uint64_t> find_key(std::uint64_t key) const;

    std::vector<std::int32_t> all() const;

private:
    /// Row of the first wall.
    std::int32_t wall_row() const { return static_cast<std::int32_t>(rows()); }

    std::optional<std::vector<std::int32_t>> numbers_;
    std::size_t                              bodies_;
};

/// A value of each row, read by the numbers of bodies that this rank has rows for.
template<class T>
struct ValuesByNumber
{
    const T& operator[](std::int64_t number) const
    {
        return of_rows[static_cast<std::size_t>(numbers.find_row(number).value())];
    }

    const BodyNumbers& numbers;
    std::vector<T>     of_rows;
};

using BodyMaterials = ValuesByNumber<std::int32_t>;

/// Change of rows: bodies have come and gone.
struct RowChange
{
    std::vector<std::int32_t> from; ///< of each present row, that before; -1: the body is new
    std::vector<std::int32_t> to;   ///< of each row before, the present one; -1: the body has gone
};

/// Change between two lists of numbers, which ascend; empty where they are the same.
std::optional<RowChange> change_between(const std::vector<std::int32_t>& before, const std::vector<std::int32_t>& now);

} // namespace tread::solver
