#include "io/snapshot.hpp"

#include <cstdio>
#include <filesystem>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "io/files.hpp"
#include "io/shared_file.hpp"

namespace tread::io
{

namespace
{

template<class T>
void write_with_unit(const h5::File& file, const std::string& name, const std::vector<T>& values, int width,
                     const std::string& unit)
{
    h5::write(file, name, values, width);
    h5::write_attribute(file, name, "units", unit);
}

template<class Index>
std::vector<Index> flattened(const std::vector<std::array<Index, 3>>& triples)
{
    std::vector<Index> values;
    values.reserve(3 * triples.size());
    for (const auto& triple : triples) { values.insert(values.end(), triple.begin(), triple.end()); }
    return values;
}

std::vector<double> flattened(const std::vector<Eigen::Vector3d>& points)
{
    std::vector<double> values;
    values.reserve(3 * points.size());
    for (const Eigen::Vector3d& point : points) { values.insert(values.end(), point.begin(), point.end()); }
    return values;
}

constexpr const char* series_name = "points.hdf.series";

std::string points_name(std::size_t number) { return fmt::format("points_{:04}.hdf", number); }

std::string temporary(const std::string& path) { return path + ".tmp"; }

template<class... T>
std::int64_t bytes_of_all(const std::vector<T>&... values)
{
    return (static_cast<std::int64_t>(values.size() * sizeof(T)) + ...);
}

std::int64_t bytes_of(const PointFields& points)
{
    constexpr std::int64_t of_cell = 8 + 8 + 1 + 4;
    return bytes_of_all(points.position, points.displacement, points.velocity, points.stress, points.plastic_shear,
                        points.plastic_rate, points.material, points.id) +
           of_cell * static_cast<std::int64_t>(points.position.size() / 3);
}

std::int64_t bytes_of(const BodyFields& bodies)
{
    return bytes_of_all(bodies.position, bodies.orientation, bodies.velocity, bodies.angular_velocity, bodies.scale,
                        bodies.shape, bodies.material);
}

} // namespace

BodyFields gathered(const Communicator& communicator, const BodyFields& fields)
{
    return {communicator.gather(fields.position), communicator.gather(fields.orientation),
            communicator.gather(fields.velocity), communicator.gather(fields.angular_velocity),
            communicator.gather(fields.scale),    communicator.gather(fields.shape),
            communicator.gather(fields.material)};
}

void write_bodies(const Communicator& communicator, const std::string& path, double time, const BodyFields& bodies,
                  const Provenance& provenance)
{
    const std::string written = communicator.broadcast(utc_now()); // all ranks must write the same
    SharedFile        file(communicator, path);
    file.together(
        [&](const h5::File& h5)
        {
            write_provenance(h5, provenance, written);
            h5::write_attribute(h5, "/", "time", time);
        });
    file.write_with_unit("/position", bodies.position, 3, "m");
    file.write_with_unit("/orientation", bodies.orientation, 4, "1");
    file.write_with_unit("/velocity", bodies.velocity, 3, "m/s");
    file.write_with_unit("/angular_velocity", bodies.angular_velocity, 3, "rad/s");
    file.write_with_unit("/scale", bodies.scale, 1, "1");
    file.write_with_unit("/shape", bodies.shape, 1, "1");
    file.write_with_unit("/material", bodies.material, 1, "1");
    file.close();
}

SnapshotWriter::SnapshotWriter(const Communicator& communicator, std::string directory, Provenance provenance)
    : communicator_(&communicator)
    , directory_(std::move(directory))
    , provenance_(std::move(provenance))
{
    on_root(communicator,
            [&]
            {
                std::error_code error;
                std::filesystem::create_directories(directory_, error);
                if (error) { throw EnvironmentError(fmt::format("{}: {}", directory_, error.message())); }
            });
}

void SnapshotWriter::write_shapes(const std::vector<NamedMesh>& shapes) const
{
    const std::string path = directory_ + "/shapes.h5";
    on_root(*communicator_,
            [&]
            {
                h5::File file = h5::File::create(temporary(path));
                write_provenance(file, provenance_);
                for (std::size_t i = 0; i < shapes.size(); ++i)
                {
                    const std::string group = fmt::format("/{}", i);
                    h5::create_group(file, group);
                    h5::write_attribute(file, group, "name", shapes[i].name);
                    write_with_unit(file, group + "/vertices", flattened(shapes[i].mesh.vertices), 3, "m");
                    write_with_unit(file, group + "/triangles", flattened(shapes[i].mesh.triangles), 3, "1");
                }
                file.close();
                rename_file(temporary(path), path);
            });
}

void SnapshotWriter::resume(std::vector<double> times)
{
    times_ = std::move(times);
    on_root(*communicator_,
            [&]
            {
                for (const auto& entry : std::filesystem::directory_iterator(directory_))
                {
                    const std::string name     = entry.path().filename().string();
                    int               number   = -1;
                    const bool        numbered = std::sscanf(name.c_str(), "points_%d.hdf", &number) == 1 ||
                                          std::sscanf(name.c_str(), "bodies_%d.h5", &number) == 1;
                    const bool later = numbered && number >= static_cast<int>(times_.size());
                    if (later || entry.path().extension() == ".tmp") { std::filesystem::remove(entry.path()); }
                }
                if (std::filesystem::exists(directory_ + "/" + series_name)) { write_series(); }
            });
}

void SnapshotWriter::write(double time, const PointFields& points, const BodyFields& bodies)
{
    const std::size_t number = times_.size();
    times_.push_back(time);
    if (communicator_->maximum(static_cast<std::int64_t>(points.position.size())) > 0)
    {
        const std::string path = directory_ + "/" + points_name(number);
        require_space_of(path, bytes_of(points));
        whole_or_not(path, [&] { write_points(*communicator_, temporary(path), time, points, provenance_); });
        on_root(*communicator_, [&] { write_series(); });
    }
    if (communicator_->maximum(static_cast<std::int64_t>(bodies.position.size())) > 0)
    {
        const std::string path = fmt::format("{}/bodies_{:04}.h5", directory_, number);
        require_space_of(path, bytes_of(bodies));
        whole_or_not(path, [&] { write_bodies(*communicator_, temporary(path), time, bodies, provenance_); });
    }
}

/// Needed with several ranks: MPI's collective calls hang if the disk of one rank is full.
void SnapshotWriter::require_space_of(const std::string& path, std::int64_t own) const
{
    if (communicator_->size() == 1) { return; }
    constexpr std::int64_t of_file = 100000;
    const std::int64_t     all     = communicator_->sum(own) + of_file;
    on_root(*communicator_, [&] { require_space(path, all); });
}

/// `work` writes the file under its temporary name.
void SnapshotWriter::whole_or_not(const std::string& path, const std::function<void()>& work) const
{
    try
    {
        work();
    }
    catch (const Error&)
    {
        if (communicator_->rank() == 0) { std::remove(temporary(path).c_str()); }
        throw;
    }
    on_root(*communicator_, [&] { rename_file(temporary(path), path); });
}

/// Lists the snapshots that have points: all, unless the last points left the domain.
void SnapshotWriter::write_series() const
{
    nlohmann::ordered_json files = nlohmann::ordered_json::array();
    for (std::size_t number = 0; number < times_.size(); ++number)
    {
        const std::string name = points_name(number);
        if (std::filesystem::exists(directory_ + "/" + name))
        {
            files.push_back({{"name", name}, {"time", times_[number]}});
        }
    }
    nlohmann::ordered_json series;
    series["file-series-version"] = "1.0";
    series["files"]               = files;
    write_atomically(directory_ + "/" + series_name, series.dump(1) + "\n");
}

} // namespace tread::io
