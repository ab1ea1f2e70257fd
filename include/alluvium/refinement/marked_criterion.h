#pragma once

#include <alluvium/refinement/size_marks.h>

namespace alluvium::refinement
{
  /** Base of the criteria that mark places and want small cells in and around them. */
  class MarkedCriterion : public RefinementCriterion
  {
  public:
    void prepare(const RefinementContext &context) final
    {
      marks.clear(context);
      if (!reads_fluid)
        {
          mark(context);
          marks.finish(MPI_COMM_SELF); // all ranks know all grains
        }
      else if (context.fluid != nullptr)
        {
          mark(context);
          marks.finish(context.fluid->space.communicator());
        }
    }

    double wanted_size(const mesh::Box &box, const RefinementContext &, const Purpose purpose) const final
    {
      return marks.wanted_size(box, purpose);
    }

    bool needs_fluid() const final { return reads_fluid; }

  protected:
    /** @p reads_fluid: mark() looks at the fluid's fields, and is called only where there are any. */
    explicit MarkedCriterion(const bool reads_fluid)
      : reads_fluid(reads_fluid)
    {}

    /** Add this rank's marks. Collective. */
    virtual void mark(const RefinementContext &context) = 0;

    SizeMarks marks;

  private:
    const bool reads_fluid;
  };
} // namespace alluvium::refinement
