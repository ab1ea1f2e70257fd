#pragma once

#include <alluvium/grains/periodicity.h>
#include <alluvium/grains/wall.h>
#include <alluvium/mesh/boundary_parts.h>
#include <alluvium/mesh/cell_weights.h>

#include <deal.II/base/point.h>
#include <deal.II/base/types.h>

#include <mpi.h>

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace dealii
{
  class ParameterHandler;
  template <int, int>
  class Triangulation;
} // namespace dealii

namespace alluvium::mesh
{
  /**
   * Where the fluid and the grains are: a rectangle with boundaries left, right, bottom and top, or a mesh file of gmsh
   * (.msh, ASCII, format 2.2 or 4.1; triangles or quadrilaterals) whose boundaries are its physical groups of
   * dimension 1.
   */
  template <int dim>
  class Domain
  {
  public:
    Domain();
    ~Domain();

    /** Declare section `Domain` in @p prm. */
    void add_parameters(dealii::ParameterHandler &prm);

    /**
     * Read the mesh file, if there is one, and find out what is asked below. Collective. Relative paths start at @p
     * directory. Throws UserError for an empty rectangle and for a file that is missing, unreadable, binary, of another
     * version, without cells, in 3-D, of higher order, of mixed cell types, or with a side of its boundary outside all
     * named physical groups.
     */
    void initialize(MPI_Comm communicator, const std::string &directory);

    const std::map<std::string, dealii::types::boundary_id> &boundary_ids() const { return ids; }

    /** Parts of sides with names of their own, which boundary_ids() has, too. Cells know their side's number only. */
    const std::vector<geometry::BoundaryPart> &parts() const { return named_parts; }

    /** Corners of the bounding box [m]. */
    const dealii::Point<dim> &lower() const { return lower_corner; }
    const dealii::Point<dim> &upper() const { return upper_corner; }

    /** Is the fluid's mesh made of triangles, which are never refined? */
    bool has_triangles() const { return triangles; }
    bool is_rectangle() const { return mesh_file.empty(); }

    /** The parameter `Coarse cell size` [m], 0 if the grains decide. */
    double coarse_cell_size() const { return coarse_size; }

    /** The parameter `Max diameters across`. */
    double most_diameters() const { return max_diameters; }

    /**
     * Numbers of cells along x and y that the rectangle's unrefined mesh has with sides of at most @p cell_size [m],
     * and as square as possible: whole numbers, however large.
     */
    std::array<double, dim> n_cells_of_rectangle(double cell_size) const;

    /**
     * The unrefined mesh, distributed over all ranks. A rectangle has cells as square as possible with sides of at most
     * @p cell_size [m] (a hair more where rounding makes them square). Cells of a file are as they are. What may be
     * refined is a parallel::distributed::Triangulation, partitioned along p4est's space-filling curve. Triangles, and
     * a rectangle that
     * @p never_refines and is not periodic, are a parallel::shared::Triangulation with artificial cells,
     * partitioned by partition_by_bisection() with @p weights, or to @p owners, if there is one for each cell.
     */
    std::unique_ptr<dealii::Triangulation<dim, dim>>
    make_triangulation(double                                          cell_size,
                       bool                                            never_refines = false,
                       const CellWeights                              &weights       = {},
                       const std::vector<dealii::types::subdomain_id> &owners        = {}) const;

    /**
     * The boundary as walls for the grains: one segment per straight side, named like the boundary, without the
     * boundaries that the parameters open to grains.
     */
    const std::vector<grains::WallSegment> &walls() const { return wall_segments; }

    /** All straight sides of the boundary, those that are open to grains included. */
    const std::vector<grains::WallSegment> &sides() const { return all_sides; }

    /** Names of the boundaries that are open to grains. */
    const std::vector<std::string> &open_to_grains_names() const { return open_names; }

    /**
     * Whether a grain with its centre at @p point has left the domain, where boundaries are open to grains: the name of
     * the nearest of these; "" if it is inside, or nowhere could leave.
     */
    std::string left_through(const std::array<double, 2> &point) const;

    /** Is (x, y) [m] in the domain, or on its boundary? Obstacles are not; a periodic box goes on for ever. */
    bool contains(double x, double y) const;

    /** The directions in which the rectangle repeats itself; its sides there are neither boundaries nor walls. */
    grains::Periodicity periodicity() const;

    /** Throws UserError if @p triangulation has fewer cells than ranks. Collective. */
    static void check_partition(const dealii::Triangulation<dim, dim> &triangulation);

  private:
    void read_mesh_file(const std::string &directory);
    void name_parts();
    void make_rectangle(dealii::Triangulation<dim, dim> &triangulation, double cell_size) const;

    dealii::Point<dim> lower_corner, upper_corner;
    std::string        mesh_file, open_to_grains, periodic_directions, parts_text;
    double             coarse_size = 0., max_diameters = 2e4;

    MPI_Comm                                          communicator;
    std::string                                       mesh_text, mesh_path;
    bool                                              triangles = false;
    std::map<std::string, dealii::types::boundary_id> ids;
    std::vector<grains::WallSegment>                  wall_segments, all_sides;
    std::vector<std::string>                          open_names;
    std::vector<geometry::BoundaryPart>               named_parts;
  };
} // namespace alluvium::mesh
