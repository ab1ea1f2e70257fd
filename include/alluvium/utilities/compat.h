#pragma once

// What differs between the versions of deal.II that we compile with, all in one place.
#include <deal.II/base/config.h>
#include <deal.II/base/data_out_base.h>
#include <deal.II/grid/reference_cell.h>

namespace alluvium::compat
{
  /** 9.6 knows the kind of cell by itself; 9.4 has to be told. */
  inline std::string
  xdmf_content(const dealii::XDMFEntry &entry, const unsigned int indent, [[maybe_unused]] dealii::ReferenceCell cell)
  {
#if DEAL_II_VERSION_GTE(9, 6, 0)
    return entry.get_xdmf_content(indent);
#else
    return entry.get_xdmf_content(indent, cell);
#endif
  }
} // namespace alluvium::compat
