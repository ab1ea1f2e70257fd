"""What the scripts for MigFlow share: one thread, silence, a mesh, and the contact forces that its API does not give."""
import contextlib
import ctypes
import importlib.metadata
import io
import os

for name in ("OMP_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[name] = "1"
os.environ["MKL_THREADING_LAYER"] = "SEQUENTIAL"
import numpy as np

import bed as beds

try:
    from migflow import fluid, scontact, time_integration
except ImportError:
    beds.missing("MigFlow", "python3 -m venv ENV && ENV/bin/pip install migflow gmsh scipy, then contrib/lab --peers ENV/bin/python")

quiet = contextlib.redirect_stdout(io.StringIO())
CONTACT_TOLERANCE = 1e-8  # MigFlow's default


def version(solver=None):
    """'MigFlow 1.4', with what it solves its linear systems with."""
    package = {"pardiso": "mkl", "scipy": "scipy"}.get(solver)
    return "MigFlow " + importlib.metadata.version("migflow") + (f" with {solver} ({package} {importlib.metadata.version(package)})" if package else "")


def grains_between_walls(bed, walls, mass):
    """A problem of grains, and which rows of its arrays they are. `walls`: pairs of points."""
    problem = scontact.ParticleProblem(2)
    problem.set_friction_coefficient(beds.FRICTION, "default", "default")
    for a, b in walls:
        problem.add_boundary_segment(np.array(a), np.array(b), "wall", "default")
    for k in range(bed.n):
        problem.add_particle((bed.x[k], bed.y[k]), bed.radius[k], mass[k])
    return problem, slice(len(problem.position()) - bed.n, None)


def true_contact_forces(problem):
    """Contact force on each row: the array that MigFlow keeps. Its own `contact_forces()` takes that for half as long as it is and gives zeros."""
    rows, address = ctypes.c_size_t(), ctypes.c_size_t()
    problem._lib.ParticleProblem_contact_forces_get(problem._p, ctypes.byref(rows), ctypes.byref(address))
    if rows.value != problem.n_particles():
        return np.zeros((problem.n_particles(), 2))
    return np.frombuffer((rows.value * 16 * ctypes.c_char).from_address(address.value), np.float64).reshape(-1, 2).copy()


def mesh_box(width, height, size):
    """gmsh's triangles in a box, of a size [m] at (x, y) that a function gives. Sides: Bottom, Top, Left, Right."""
    try:
        import gmsh
    except ImportError:
        beds.missing("gmsh", "ENV/bin/pip install gmsh")
    if not gmsh.is_initialized():
        gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.model.add("box")
    gmsh.model.occ.add_rectangle(0, 0, 0, width, height)
    gmsh.model.occ.synchronize()
    margin = 1e-4 * width
    for name, box in {"Bottom": (0, 0, width, 0), "Top": (0, height, width, height), "Left": (0, 0, 0, height), "Right": (width, 0, width, height)}.items():
        found = gmsh.model.get_entities_in_bounding_box(box[0] - margin, box[1] - margin, -1, box[2] + margin, box[3] + margin, 1, 1)
        gmsh.model.add_physical_group(1, [tag for _, tag in found], name=name)
    gmsh.model.add_physical_group(2, [1], name="domain")
    for name in ("MeshSizeExtendFromBoundary", "MeshSizeFromPoints"):
        gmsh.option.setNumber("Mesh." + name, 0)
    gmsh.model.mesh.set_size_callback(lambda dim, tag, x, y, z, h: size(x, y))
    gmsh.model.mesh.generate(2)


class BedInWater:
    """The fluid of a bed between slip walls, water driven by the pressure at the bottom, on gmsh's triangles."""

    RHO, ETA = 1000.0, 1e-3

    def __init__(self, bed, options, head, gravity=beds.GRAVITY):
        """`head()`: what drives the water upwards, now [m]. Pressures are what it and gravity make of them; at the top they are 0."""
        h, far, top, d = options.cells * bed.diameter, 8 * bed.diameter, options.bed_height, bed.diameter
        # finer at the faces: as our `bed faces` has it, four diameters to each side
        size = (lambda x, y: h) if not options.faces else lambda x, y: min(max(h, h + 0.3 * (min(abs(y), abs(y - top)) - 4 * d)), far)
        mesh_box(bed.width, options.height, size)
        pressure = lambda: self.RHO * (gravity * options.height + beds.GRAVITY * head())
        with quiet:
            self.problem = fluid.FluidProblem(2, np.array([0.0, -gravity]), [self.ETA], [self.RHO], solver=options.solver)
        self.problem.load_msh(None)
        self.problem.set_wall_boundary(["Left", "Right"])
        self.problem.set_open_boundary("Top", pressure=lambda x: np.zeros(len(x)))
        self.problem.set_open_boundary("Bottom", pressure=lambda x: np.full(len(x), pressure()))
        self.problem.interpolate(pressure=lambda x: self.RHO * (gravity * (options.height - x[:, 1]) + beds.GRAVITY * head() * np.clip(1 - x[:, 1] / top, 0, 1)))
        self.volume = np.pi * (options.radius_factor * bed.radius)**2
        self.triangles, self.unknowns = self.problem.n_elements(), 3 * self.problem.n_nodes()


def fluid_options(parser):
    """What the scripts for beds in water are asked."""
    parser.add_argument("bed")
    parser.add_argument("--cells", type=float, default=2.0, help="size of the triangles over the mean diameter")
    parser.add_argument("--faces", action="store_true", help="of that size at the bed's faces only, 8 elsewhere")
    parser.add_argument("--height", type=float, required=True, help="of the domain [m]")
    parser.add_argument("--bed-height", type=float, required=True, help="[m]")
    parser.add_argument("--radius-factor", type=float, default=1.0, help="radius that the fluid sees over that which touches")
    parser.add_argument("--dt", type=float, default=1e-3, help="time step [s]")
    parser.add_argument("--solver", default="pardiso", help="of the linear systems: pardiso or scipy")
    options = parser.parse_args()
    return options, beds.Bed(options.bed)
