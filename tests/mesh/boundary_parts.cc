// Named parts of sides: what they say is what they are, or the text is refused.
#include <alluvium/mesh/boundary_parts.h>
#include <alluvium/utilities/user_error.h>

#include <gtest/gtest.h>

namespace
{
  using namespace alluvium;

  /** What is complained about in @p text, on a box of 3 cm x 2 cm; empty: nothing. */
  std::string complaint(const std::string &text)
  {
    const std::vector<mesh::BoundarySide> sides = {{{{0., 0.}}, {{0., 0.02}}, 0},
                                                   {{{0.03, 0.}}, {{0.03, 0.02}}, 1},
                                                   {{{0., 0.}}, {{0.03, 0.}}, 2},
                                                   {{{0., 0.02}}, {{0.03, 0.02}}, 3}};
    std::map<std::string, unsigned int>   ids   = {{"left", 0}, {"right", 1}, {"bottom", 2}, {"top", 3}};
    try
      {
        mesh::parse_boundary_parts(text, sides, ids);
      }
    catch (const UserError &error)
      {
        return error.what();
      }
    return "";
  }

  bool complains(const std::string &text, const std::string &part)
  {
    return complaint(text).find(part) != std::string::npos;
  }
} // namespace

TEST(BoundaryParts, WithinTheirSide)
{
  EXPECT_EQ(complaint("a = bottom: 0.014 < x < 0.016; b = left: y > 0.01; c = top: x < 0.03"), "");
  EXPECT_EQ(complaint("a = bottom: 0 < x < 0.03"), "");
  EXPECT_EQ(complaint("a = bottom: x < 1"), ""); // all of it
  EXPECT_TRUE(complains("a = top: 0.018 < x < 0.035", "reaches beyond 'top', which goes from x = 0 to 0.03 m"));
  EXPECT_TRUE(complains("a = bottom: 0.012 < x < 0.011", "ends before it begins"));
  EXPECT_TRUE(complains("a = bottom: 0.04 < x < 0.05", "no point of 'bottom' lies there"));
}
