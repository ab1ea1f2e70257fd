#pragma once

#include <alluvium/utilities/plugin_interface.h>

namespace alluvium::contacts
{
  /**
   * Interface of the plug-ins for cohesion: what attracts two grains, or a grain and a wall, that touch or have
   * touched.
   *
   * Touching makes a bond, which lasts while they touch or while their gap is below reach(). A bond attracts with
   * force(), as an outer load of both; a closed contact carries that load besides all others, so that its impulse r of
   * the sub-step h obeys r >= 0 where r - h force is what it exchanges in all, and Coulomb's limit is mu r. The sweeps
   * know nothing of it.
   */
  class Cohesion : public Plugin
  {
  public:
    /** Whether there is any attraction; if not, nothing else is asked. */
    virtual bool acts() const { return true; }

    /**
     * Attraction [N/m] at a gap of @p gap >= 0 [m] of two grains with radii r1 and r2 and reduced radius
     * @p reduced_radius = r1 r2 / (r1 + r2) [m]; with a wall, the reduced radius is the grain's.
     */
    virtual double force(double gap, double reduced_radius) const = 0;

    /** The largest gap that a bond survives [m]; 0: it ends with the contact. */
    virtual double reach(double reduced_radius) const = 0;
  };
} // namespace alluvium::contacts
