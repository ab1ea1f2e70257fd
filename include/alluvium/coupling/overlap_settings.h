#pragma once

#include <alluvium/geometry/grid_cutter.h>

#include <string>

namespace dealii
{
  class ParameterHandler;
}

namespace alluvium::coupling
{
  /** Over what disc a grain is spread and how, and how shape functions are integrated over its pieces. */
  struct OverlapSettings
  {
    enum class Rule
    {
      centroid,       // shape functions at the piece's centroid (the paper): exact for linear functions
      moments,        // with second moments: exact for Q1 on parallelograms
      particle_centre // all of a grain evenly in the cell that has its centre, whatever the filter: jumps from cell to
                      // cell
    };
    /** How a grain is spread over the filter's disc, the kernel: top hat, or parabolic, as 2 (1 - q^2/R^2) of the
     * distance q from the centre, so that nothing jumps at the edge. */
    using Shape = geometry::DiscWeight;
    double filter_radius =
      2.; // in contact diameters; 0: the grain's own fluid radius, over which it is always a top hat
    Rule rule = Rule::moments;
    /** A grain that has moved by less than this [contact diameters] since it was cut is not cut again. */
    double tolerance = 1e-6;
    bool   keep_arms = false; // see OverlapMap::arms()
    Shape  shape     = Shape::top_hat;

    /** The shape that the discs have. */
    Shape shape_of_discs() const { return filter_radius > 0. ? shape : Shape::top_hat; }
  };

  /** The settings as parameters of section `Coupling`. */
  class OverlapParameters
  {
  public:
    void add_parameters(dealii::ParameterHandler &prm);
    /** What the parameters say. Throws UserError for a filter's radius that cannot be. */
    OverlapSettings settings() const;

  private:
    std::string radius = "2 d", shape = "top-hat", rule = "moments";
    double      tolerance = OverlapSettings().tolerance;
  };
} // namespace alluvium::coupling
