// The order of contacts: colours that share no grain, whatever the numbering.
#include <alluvium/contacts/search/contact_colouring.h>

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

using namespace alluvium::contacts;
using namespace alluvium::grains;

namespace
{
  constexpr double d = 1e-3;

  GrainArrays lattice(const unsigned int n_x, const unsigned int n_y)
  {
    GrainArrays grains;
    grains.resize(n_x * n_y);
    for (unsigned int k = 0; k < grains.n(); ++k)
      {
        grains.id[k]          = 3 * k + 1;
        grains.position[0][k] = (k % n_x + 0.5 * (k / n_x % 2)) * d;
        grains.position[1][k] = (0.5 + k / n_x * std::sqrt(0.75)) * d;
        grains.radius[k]      = 0.5 * d;
      }
    return grains;
  }

  ContactGeometry floor()
  {
    ContactGeometry geometry;
    geometry.walls.set({{{{-1., 0.}}, {{1., 0.}}, {{0., 0.}}, "floor"}});
    return geometry;
  }

  /** Colours by the ids of the pairs. */
  std::map<std::array<GrainId, 2>, unsigned int> colours(const GrainArrays &grains, ContactCandidates &pairs)
  {
    colour_contacts(grains, pairs);
    std::map<std::array<GrainId, 2>, unsigned int> result;
    for (const ContactPair &p : pairs.discs)
      result[{{grains.id[p.i], grains.id[p.j]}}] = p.colour;
    for (const ContactPair &p : pairs.walls)
      result[{{grains.id[p.i], ~p.j}}] = p.colour;
    return result;
  }

  void expect_proper(const GrainArrays &grains, const ContactCandidates &pairs)
  {
    std::set<std::array<unsigned int, 2>> taken;
    for (const ContactPair &p : pairs.discs)
      for (const auto k : {p.i, p.j})
        EXPECT_TRUE(taken.insert(std::array<unsigned int, 2>{{k, p.colour}}).second) << grains.id[k];
    for (const ContactPair &p : pairs.walls)
      EXPECT_TRUE(taken.insert(std::array<unsigned int, 2>{{p.i, p.colour}}).second) << grains.id[p.i];
  }
} // namespace

TEST(ContactColouring, NoTwoOfAColourShareAGrain)
{
  const GrainArrays grains    = lattice(20, 20);
  ContactCandidates pairs     = find_candidates(grains, floor(), 0.15 * d);
  const unsigned    n_colours = colour_contacts(grains, pairs);
  EXPECT_EQ(pairs.walls.size(), 20u);
  EXPECT_EQ(pairs.discs.size(), 20u * 19u + 19u * 39u);
  EXPECT_LE(n_colours, 11u); // at most twice the number of neighbours, less one
  expect_proper(grains, pairs);
}

TEST(ContactColouring, DoesNotDependOnTheNumbering)
{
  const GrainArrays grains   = lattice(12, 9);
  GrainArrays       shuffled = grains;
  const std::size_t n        = grains.n();
  for (std::size_t k = 0; k < n; ++k)
    {
      const std::size_t from  = (47 * k + 11) % n;
      shuffled.id[k]          = grains.id[from];
      shuffled.position[0][k] = grains.position[0][from];
      shuffled.position[1][k] = grains.position[1][from];
    }
  ContactCandidates a = find_candidates(grains, floor(), 0.15 * d), b = find_candidates(shuffled, floor(), 0.15 * d);
  const auto        colours_a = colours(grains, a), colours_b = colours(shuffled, b);
  EXPECT_GT(colours_a.size(), 200u);
  EXPECT_EQ(colours_a, colours_b);
}

// More contacts at one grain than bits in a word.
TEST(ContactColouring, ManyNeighbours)
{
  GrainArrays        grains;
  const unsigned int n = 300;
  grains.resize(n + 1);
  grains.radius[n] = n * d / (2. * M_PI);
  for (unsigned int k = 0; k < n; ++k)
    {
      const double a        = 2. * M_PI * k / n;
      grains.radius[k]      = 0.45 * d;
      grains.position[0][k] = (grains.radius[n] + 0.5 * d) * std::cos(a);
      grains.position[1][k] = (grains.radius[n] + 0.5 * d) * std::sin(a);
    }
  for (unsigned int k = 0; k <= n; ++k)
    grains.id[k] = k;
  ContactCandidates pairs = find_candidates(grains, ContactGeometry(), 0.15 * d);
  EXPECT_GE(colour_contacts(grains, pairs), n);
  expect_proper(grains, pairs);
}
