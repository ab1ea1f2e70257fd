#pragma once

#include <alluvium/geometry/upright.h>
#include <alluvium/grains/periodicity.h>
#include <alluvium/grains/wall.h>
#include <alluvium/utilities/plugin_interface.h>

#include <array>
#include <string>
#include <vector>

namespace alluvium::deposits
{
  /** One grain as a deposit makes it: SI, per unit depth. */
  struct NewGrain
  {
    double x, y, radius, density;
    double vx = 0., vy = 0., omega = 0.;
  };

  /** What a deposit may know of the scene. */
  struct DepositContext
  {
    std::array<double, 2>            lower, upper; // bounding box of the domain [m]
    std::vector<grains::WallSegment> walls;
    double                           density;               // default grain density [kg/m^3]
    std::array<double, 2>            gravity;               // [m/s^2]
    std::string                      directory;             // of the parameter file: relative paths start here
    grains::Periodicity              periodicity = {};      // of the domain
    bool                             may_write   = true;    // files: caches. Not where a scene is only looked at
    std::vector<std::string>        *warnings    = nullptr; // where to put what the user should know, if anywhere
    geometry::Upright                upright     = {};      // how all this has been turned; parameters have not
    std::vector<grains::WallSegment> sides       = {};      // the whole boundary, if it is not the bounding box
    bool                             moves       = true;    // will the grains move?
  };

  /**
   * Interface of the plug-ins that give the initial packing: where the grains are at t = 0. make() runs on one rank
   * only; the result is sent to the others. It must be reproducible: the same parameters and seed give the same grains.
   */
  class Deposit : public Plugin
  {
  public:
    virtual std::vector<NewGrain> make(const DepositContext &context) const = 0;

    /** Does it put grains down on a floor? Then it is given a scene turned upright, and what it makes is turned back.
     */
    virtual bool falls() const { return false; }

    /** Of a deposit that is meant to make no grains: what stands for their diameter [m]. Else 0. */
    virtual double unit_length() const { return 0.; }
  };
} // namespace alluvium::deposits
