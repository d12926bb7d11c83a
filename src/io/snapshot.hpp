#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "base/communicator.hpp"
#include "io/provenance.hpp"
#include "shape/mesh/mesh.hpp"

namespace tread::io
{

/// This rank's material points, row-major host arrays of n points. An array that is empty on every rank is left out of
/// the file.
struct PointFields
{
    std::vector<double>        position;      ///< [n][3] m, world
    std::vector<float>         displacement;  ///< [n][3] m, since the start
    std::vector<float>         velocity;      ///< [n][3] m/s
    std::vector<float>         stress;        ///< [n][6] Pa, tension positive: xx, yy, zz, yz, xz, xy
    std::vector<float>         plastic_shear; ///< [n] equivalent plastic shear strain
    std::vector<float>         plastic_rate;  ///< [n] 1/s
    std::vector<std::int32_t>  material;      ///< [n]
    std::vector<std::uint32_t> id;            ///< [n] unique over the whole run
    std::vector<float>         volume_ratio;  ///< [n] present over initial volume; not in snapshots
};

/// Rigid bodies, row-major host arrays of n bodies: in a run on several ranks this rank's block of them (BodyBlocks).
struct BodyFields
{
    std::vector<double>       position;         ///< [n][3] m, world, centre of mass
    std::vector<double>       orientation;      ///< [n][4] quaternion w, x, y, z, body to world
    std::vector<double>       velocity;         ///< [n][3] m/s
    std::vector<double>       angular_velocity; ///< [n][3] rad/s
    std::vector<double>       scale;            ///< [n] of the shape
    std::vector<std::int32_t> shape;            ///< [n] index in shapes.h5
    std::vector<std::int32_t> material;         ///< [n] number of the [[material]] table, from 0
};

/// The fields of all ranks, one after the other, on every rank. Collective.
BodyFields gathered(const Communicator& communicator, const BodyFields& fields);

/// Surface of a shape at scale 1 in the body frame, to draw bodies.
struct NamedMesh
{
    std::string         name;
    shape::TriangleMesh mesh;
};

/// Writes the numbered snapshots of a run. A file gets its name once it is complete. Collective; a failure is an
/// EnvironmentError on all ranks and leaves no file behind.
class SnapshotWriter
{
public:
    /// Creates the directory.
    SnapshotWriter(const Communicator& communicator, std::string directory, Provenance provenance = {});

    /// Times (s) of the snapshots so far, by number.
    const std::vector<double>& times() const { return times_; }

    /// Continues a series of snapshots: removes later and partial files that exist, and lists no others in the series.
    void resume(std::vector<double> times);

    /// Writes shapes.h5: /<index>/{vertices [v][3] m, triangles [t][3]}, attribute name.
    void write_shapes(const std::vector<NamedMesh>& shapes) const;

    /// Writes the snapshot of the next number: points_0007.hdf and points.hdf.series if any rank has points,
    /// bodies_0007.h5 if there are bodies. `time` in s.
    void write(double time, const PointFields& points, const BodyFields& bodies);

private:
    void write_series() const;
    void require_space_of(const std::string& path, std::int64_t own) const;
    void whole_or_not(const std::string& path, const std::function<void()>& work) const;

    const Communicator* communicator_;
    std::string         directory_;
    Provenance          provenance_;
    std::vector<double> times_;
};

/// Writes a VTKHDF 1.0 file: an UnstructuredGrid of vertices, one partition per rank, with point data `displacement`,
/// `velocity`, `stress`, `plastic_shear`, `plastic_rate`, `material`, `id` and `rank`; each has an attribute `units`.
/// Stress components are in VTK's order xx, yy, zz, xy, yz, xz (also in the attribute `components`). `time` and the
/// provenance are attributes of the root. Collective. Layout:
/// https://docs.vtk.org/en/latest/design_documents/VTKFileFormats.html#vtkhdf
void write_points(const Communicator& communicator, const std::string& path, double time, const PointFields& points,
                  const Provenance& provenance = {});

/// Writes an HDF5 file with the arrays of BodyFields, ranks one after the other, `units` on each, `time` on the root.
/// Collective.
void write_bodies(const Communicator& communicator, const std::string& path, double time, const BodyFields& bodies,
                  const Provenance& provenance = {});

} // namespace tread::io
