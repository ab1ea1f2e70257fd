#pragma once

#include <alluvium/grains/grain_arrays.h>

namespace alluvium::grains
{
  /** One quantity that every grain has: a number, or a vector with a component per direction. */
  class GrainColumn
  {
  public:
    enum class When
    {
      constant, // from the deposit on
      changing  // in a step of the grains
    };

    constexpr GrainColumn(const char         *name,
                          const char         *unit,
                          const When          when,
                          const bool          in_pictures,
                          std::vector<double> GrainArrays::*number)
      : name(name)
      , unit(unit)
      , when(when)
      , in_pictures(in_pictures)
      , n_components(1)
      , number(number)
    {}

    constexpr GrainColumn(
      const char *name, const char *unit, const When when, const bool in_pictures, Components GrainArrays::*vector)
      : name(name)
      , unit(unit)
      , when(when)
      , in_pictures(in_pictures)
      , n_components(2)
      , vector(vector)
    {}

    /** The column's values of @p component, one for each of @p grains, which may be const. */
    template <typename Grains>
    auto &values(Grains &grains, const unsigned int component) const
    {
      return n_components == 1 ? grains.*number : (grains.*vector)[component];
    }

    const char *const  name; // in files
    const char *const  unit;
    const When         when;
    const bool         in_pictures;
    const unsigned int n_components;

  private:
    std::vector<double> GrainArrays::*number = nullptr;
    Components GrainArrays::*vector          = nullptr;
  };

  /** All of them: a new one is added here and in GrainArrays, and nowhere else. Their order is that of files. */
  inline constexpr std::array<GrainColumn, 8> grain_columns = {
    {{"position", "m", GrainColumn::When::changing, false, &GrainArrays::position},
     {"radius", "m", GrainColumn::When::constant, true, &GrainArrays::radius},
     {"fluid_radius", "m", GrainColumn::When::constant, false, &GrainArrays::fluid_radius},
     {"mass", "kg/m", GrainColumn::When::constant, false, &GrainArrays::mass},
     {"velocity", "m/s", GrainColumn::When::changing, true, &GrainArrays::velocity},
     {"angular_velocity", "rad/s", GrainColumn::When::changing, true, &GrainArrays::omega},
     {"contact_force", "N/m", GrainColumn::When::changing, true, &GrainArrays::contact_force},
     {"initial_position", "m", GrainColumn::When::changing, false, &GrainArrays::initial_position}}};

  constexpr unsigned int count_components()
  {
    unsigned int n = 0;
    for (const GrainColumn &column : grain_columns)
      n += column.n_components;
    return n;
  }

  /** Numbers that a grain has in all columns, without its id. */
  inline constexpr unsigned int n_grain_numbers = count_components();

  /** Call @p use(values, column) for each component of each column of @p grains, which may be const. */
  template <typename Grains, typename Function>
  void for_each_column(Grains &grains, const Function &use)
  {
    for (const GrainColumn &column : grain_columns)
      for (unsigned int c = 0; c < column.n_components; ++c)
        use(column.values(grains, c), column);
  }

  /** The arrays of those columns of @p grains that are @p when, component by component. */
  template <typename Grains>
  auto columns_of(Grains &grains, const GrainColumn::When when)
  {
    std::vector<decltype(&grains.radius)> result;
    for_each_column(grains, [&](auto &values, const GrainColumn &column) {
      if (column.when == when)
        result.push_back(&values);
    });
    return result;
  }
} // namespace alluvium::grains
