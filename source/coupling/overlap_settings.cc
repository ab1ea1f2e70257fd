#include <alluvium/coupling/overlap_settings.h>
#include <alluvium/utilities/user_error.h>

#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/utilities.h>

namespace alluvium::coupling
{
  using namespace dealii;

  void OverlapParameters::add_parameters(ParameterHandler &prm)
  {
    prm.add_parameter(
      "Filter radius",
      radius,
      "Radius of the disc over which a grain gives to and reads from the fluid: `grain` (its own fluid radius, as in "
      "the paper) or a multiple of its contact diameter, e.g. `2 d`. On cells finer than about two grain diameters "
      "only 1.5 d to 2 d give the right flux through a bed.");
    prm.add_parameter(
      "Filter shape",
      shape,
      "How a grain is spread over the filter's disc, the kernel: `top-hat` (evenly), or `parabolic` (Epanechnikov), as "
      "1 - q^2/R^2 of the distance q from its centre, so that nothing jumps where the edge of the disc crosses cells; "
      "one of `2.5 d` is as wide as a top hat of `2 d`. With `Filter radius = grain` always a top hat. `even` and "
      "`smooth` are old names of the two.",
      Patterns::Selection("top-hat|parabolic|even|smooth"));
    prm.add_parameter(
      "Overlap rule",
      rule,
      "How shape functions are integrated over the pieces of a grain: `centroid` (the paper: at the piece's centroid, "
      "exact for linear functions), `moments` (with second moments: exact for bilinear functions on parallelograms) "
      "or, for comparison only, `particle-centre` (PCM: a grain is spread evenly over the cell that has its centre, "
      "and "
      "jumps from cell to cell; there is no filter; `centre` is its old name).",
      Patterns::Selection("centroid|moments|particle-centre|centre"));
    prm.add_parameter("Overlap tolerance",
                      tolerance,
                      "A grain that has moved by less than this times its diameter keeps its pieces; in a bed at rest "
                      "nothing is cut. At 0 every grain that moved at all is cut.",
                      Patterns::Double(0., 0.1));
  }


  OverlapSettings OverlapParameters::settings() const
  {
    OverlapSettings   result;
    const std::string text = Utilities::trim(radius);
    if (text == "grain")
      result.filter_radius = 0.;
    else
      {
        std::size_t end = 0;
        double      x   = 0.;
        try
          {
            x = std::stod(text, &end);
          }
        catch (const std::exception &)
          {}
        check_user(end > 0 && Utilities::trim(text.substr(end)) == "d" && x >= 0.5 && x <= 20.,
                   "Coupling/Filter radius: expected `grain` or a number of grain diameters between 0.5 and 20 "
                   "followed by d, such as `2 d`; got '" +
                     radius + "'.");
        result.filter_radius = x;
      }
    result.shape =
      shape == "parabolic" || shape == "smooth" ? OverlapSettings::Shape::parabolic : OverlapSettings::Shape::top_hat;
    check_user(
      result.shape_of_discs() == OverlapSettings::Shape::top_hat || result.filter_radius >= 1.,
      "Coupling/Filter radius: a parabolic filter needs at least `1 d`, since in the middle it weighs twice its "
      "mean; got '" +
        radius + "'.");
    result.rule      = rule == "centroid"  ? OverlapSettings::Rule::centroid
                       : rule == "moments" ? OverlapSettings::Rule::moments
                                           : OverlapSettings::Rule::particle_centre;
    result.tolerance = tolerance;
    return result;
  }
} // namespace alluvium::coupling
