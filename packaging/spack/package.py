from spack.package import *


class Tread(CMakePackage, CudaPackage):
    """Rover wheels on sand, rock and mixtures: Material Point Method, DEM and their coupling, on GPUs and many ranks."""

    # No release is published: `spack develop --path /path/to/clone tread@=main`, or set `git` to your clone.
    version("main", branch="main")
    license("BSD-3-Clause")

    variant("petsc", default=False, description="Partitions by PTScotch through PETSc")
    variant("python", default=True, description="What the scripts want")

    depends_on("cxx", type="build")
    depends_on("c", type="build")
    depends_on("cmake@3.25:", type="build")
    depends_on("ninja", type="build")
    depends_on("pkgconfig", type="build", when="+petsc")
    depends_on("mpi")
    depends_on("hdf5@1.10: +mpi")
    depends_on("metis@5.1:")
    depends_on("eigen@3.4:3")
    depends_on("toml11@3")
    depends_on("cli11@2")
    depends_on("fmt")
    depends_on("muparser")
    depends_on("qhull")
    depends_on("nlohmann-json")
    depends_on("petsc@3.18: +mpi +ptscotch", when="+petsc")
    depends_on("cuda@12:", when="+cuda")
    with when("+python"):
        depends_on("python@3.11:", type="run")
        depends_on("py-h5py", type="run")
        depends_on("py-numpy", type="run")
        depends_on("py-scipy", type="run")
        depends_on("py-matplotlib", type="run")
        depends_on("py-pillow", type="run")

    conflicts("cuda_arch=none", when="+cuda", msg="tread wants to know the GPU: cuda_arch=90")

    def cmake_args(self):
        args = [
            self.define("TREAD_TESTS", False),
            self.define("TREAD_CUDA", "ON" if self.spec.satisfies("+cuda") else "OFF"),
            self.define("TREAD_PETSC", "ON" if self.spec.satisfies("+petsc") else "OFF"),
        ]
        if self.spec.satisfies("+cuda"):
            args.append(self.define("CMAKE_CUDA_ARCHITECTURES", self.spec.variants["cuda_arch"].value))
        return args

    def setup_run_environment(self, env):
        if self.spec.satisfies("+python"):
            env.set("TREAD_PYTHON", self.spec["python"].command.path)
