#pragma once

#include <alluvium/grains/wall.h>
#include <alluvium/mesh/domain.h>

#include <map>
#include <string>
#include <vector>

namespace dealii
{
  class ParameterHandler;
}

namespace alluvium::run
{
  /** The walls of the grains: those of the domain, extra ones, how they move and when they are there. */
  class WallSetup
  {
  public:
    /** Declare them in the current section of @p prm, which is "Grains". */
    void add_parameters(dealii::ParameterHandler &prm);

    /**
     * Walls of the domain plus the extra ones, with their images if the domain is periodic, as they are at t = 0.
     * Throws UserError for a wall, a motion or a time that cannot be read, or that fits no wall.
     */
    std::vector<grains::WallSegment> walls(const mesh::Domain<2> &domain) const;

  private:
    /** What the parameters say of the walls of one name. */
    struct Motion
    {
      grains::WallMotion    motion;
      bool                  rigid = false, turns = false;
      std::array<double, 2> centre = {{0., 0.}};       // where it turns [m]
      std::array<bool, 2>   may_go = {{false, false}}; // can its velocity have this component?
      std::string           written_in;                // the parameter
    };

    std::vector<grains::WallSegment> read_extra_walls() const;
    std::map<std::string, Motion>    read_motions() const;
    void                             read_motion(const std::string &item, std::map<std::string, Motion> &motions) const;
    void read_presence(const std::string &item, std::map<std::string, Motion> &motions) const;

    std::string extra_walls, wall_motion, wall_presence;
  };
} // namespace alluvium::run
