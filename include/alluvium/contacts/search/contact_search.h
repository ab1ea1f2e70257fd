#pragma once

#include <alluvium/grains/grain_arrays.h>
#include <alluvium/grains/periodicity.h>
#include <alluvium/grains/wall.h>

#include <array>
#include <cstdint>
#include <vector>

namespace alluvium::contacts
{
  /** Two grains, the one of lower id first, or grain i and wall segment j, that may touch, and the impulse they last
   * exchanged [N s/m]. */
  struct ContactPair
  {
    std::uint32_t i, j;
    std::uint32_t colour = 0;                // pairs of one colour share no grain; see colour_contacts()
    bool          bonded = false;            // by cohesion: they touch, or did and have not parted for good
    double        rn = 0., rt = 0., rr = 0.; // normal, tangential, and of rolling friction over the reduced radius
  };

  /**
   * Where a disc is nearest to something: unit normal from the disc towards it, the gap [m], negative in overlap, and
   * for a wall its velocity there [m/s].
   */
  struct ContactPoint
  {
    double nx, ny, gap;
    double vx = 0., vy = 0.;
  };

  /**
   * Wall segments that know where they meet: share an end, end on one another, lie on one another. A disc touches a
   * point of several segments once: it belongs to the first of them, and only if no other is nearer. So a disc and a
   * segment have one contact or none.
   */
  class WallGeometry
  {
  public:
    void                                    set(std::vector<grains::WallSegment> segments);
    const std::vector<grains::WallSegment> &segments() const { return walls; }

    /** When the next step starts [s]: walls may depend on it. */
    void set_time(const double t) { time = t; }

    /** Take velocities and presence of the walls for a sub-step of length @p h [s] that starts now. */
    void begin_substep(double h);

    /**
     * Move the walls on by @p dt [s]. A wall that is not rigid and does not rotate moves by the normal part of its
     * velocity only: the tangential part is that of a belt, which drags grains along and leaves the wall where it is.
     */
    void move(double dt);

    /** Does any wall move, appear or vanish within @p dt [s] from now, or since the last sub-step? */
    bool act(double dt) const;

    /** Into how many sub-steps walls that rotate divide a step of @p dt [s]. */
    unsigned int count_substeps(double dt, double smallest_diameter) const;

    /** Where the walls are, as in ContactArchive; and to put them there. */
    std::vector<double> positions() const;
    void                place(const std::vector<double> &positions);

    /** The same of @p segments, whether they ever move or not. */
    static std::vector<double> positions_of(const std::vector<grains::WallSegment> &segments);

    /** The largest speed of any wall that is present [m/s]. */
    double largest_speed() const;

    /** The contact of a disc at (x, y) with radius r and segment @p k; false if another segment owns it. */
    bool touch(std::size_t k, double x, double y, double r, ContactPoint &point) const;

  private:
    std::vector<grains::WallSegment>        walls;
    std::vector<std::vector<std::uint32_t>> meeting; // the other segments that a segment has points in common with
    bool                                    moving = false; // some act at some time
    double                                  time   = 0.;    // [s]

    void find_meetings();
  };

  /** What the grains are in: walls, and perhaps a box that repeats itself. */
  struct ContactGeometry
  {
    WallGeometry        walls;
    grains::Periodicity periodicity;
  };

  /** Bring all grains into a periodic box. Their displacement since t = 0 stays what it is. */
  void wrap_into_box(grains::GrainArrays &grains, const grains::Periodicity &periodicity);

  /** The contact of grains @p i and @p j, or of their nearest images; the normal points from i to j. */
  ContactPoint
  touch(const grains::GrainArrays &grains, const grains::Periodicity &periodicity, std::uint32_t i, std::uint32_t j);

  /** All pairs that may touch, found with a uniform cell grid. Where the grains are sorted by id, so are the pairs. */
  struct ContactCandidates
  {
    std::vector<ContactPair> discs, walls;
  };

  /**
   * Find all pairs of grains, and of grains and walls, with gaps below @p skin [m]. Cells are as wide as the largest
   * grain plus the skin, so a grain's partners are in its own cell and the eight around it. In a periodic direction the
   * grains must lie in the box, and the nearest image counts. Throws a Divergence if a grain's position is not
   * finite, and UserError if a periodic box is so narrow that a grain could touch two images of another.
   */
  ContactCandidates find_candidates(const grains::GrainArrays &grains, const ContactGeometry &geometry, double skin);
} // namespace alluvium::contacts
