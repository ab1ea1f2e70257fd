#include <alluvium/scene/declared_parameters.h>
#include <alluvium/scene/parameter_file.h>

#include <deal.II/base/parameter_handler.h>

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include <unistd.h>

using namespace alluvium::scene;

namespace
{
  std::string words(const dealii::Patterns::PatternBase &pattern)
  {
    return allowed_in_words(pattern.description());
  }

  void declare(dealii::ParameterHandler &prm)
  {
    using namespace dealii::Patterns;
    prm.declare_entry("Zeta", "1", Integer(), "First declared, last in the alphabet.");
    prm.enter_subsection("Section (a/b)");
    prm.enter_subsection("Inner");
    prm.declare_entry("Name, with: odd [characters]", "", Anything(), "Line one.\nLine two.");
    prm.leave_subsection();
    prm.declare_entry("After the section", "0.5", Double(0, 1), "Declared after it [m].");
    prm.leave_subsection();
    prm.enter_subsection("Empty");
    prm.leave_subsection();
    prm.declare_entry("Alpha", "a", Selection("a|b"), std::string(150, 'x') + " " + std::string(50, 'y'));
  }
} // namespace

TEST(DeclaredParameters, PatternsInWords)
{
  using namespace dealii::Patterns;
  EXPECT_EQ(words(Bool()), "true or false");
  EXPECT_EQ(words(Integer()), "a whole number");
  EXPECT_EQ(words(Integer(0)), "a whole number >= 0");
  EXPECT_EQ(words(Integer(1, 3)), "a whole number from 1 to 3");
  EXPECT_EQ(words(Integer(-5, 3)), "a whole number from -5 to 3");
  EXPECT_EQ(words(Double()), "a number");
  EXPECT_EQ(words(Double(1e-3)), "a number >= 0.001");
  EXPECT_EQ(words(Double(Double::min_double_value, 2)), "a number <= 2");
  EXPECT_EQ(words(Double(0, 0.5)), "a number from 0 to 0.5");
  EXPECT_EQ(words(Selection("one|two words")), "one of: one, two words");
  EXPECT_EQ(words(MultipleSelection("a|b")), "any of these, separated by commas: a, b");
  EXPECT_EQ(words(List(Double(0), 2, 2)), "2 values separated by commas, each a number >= 0");
  EXPECT_EQ(words(List(Integer(), 1, 3, ";")), "1 to 3 values separated by ';', each a whole number");
  EXPECT_EQ(words(List(List(Double(), 2, 2), 0, List::max_int_value, ";")),
            "any number of values separated by ';', each 2 values separated by commas, each a number");
  EXPECT_EQ(words(Map(Anything(), Double())),
            "pairs key:value separated by commas, each key any text, each value a number");
  EXPECT_EQ(words(FileName()), "a file name");
  EXPECT_EQ(words(DirectoryName()), "a folder name");
}

TEST(DeclaredParameters, FindsWhatIsDeclared)
{
  dealii::ParameterHandler prm;
  declare(prm);
  const DeclaredParameters declared(prm);
  ASSERT_EQ(declared.parameters().size(), 4u);
  ASSERT_NE(declared.find({"Section (a/b)", "Inner", "Name, with: odd [characters]"}), nullptr);
  ASSERT_NE(declared.find({"Section (a/b)", "After the section"}), nullptr);
  EXPECT_EQ(declared.find({"Section (a/b)", "After the section"})->default_value, "0.5");
  EXPECT_EQ(declared.find({"After the section"}), nullptr);
  EXPECT_TRUE(declared.has_section({}));
  EXPECT_TRUE(declared.has_section({"Section (a/b)", "Inner"}));
  EXPECT_TRUE(declared.has_section({"Empty"}));
  EXPECT_FALSE(declared.has_section({"Inner"}));
  EXPECT_EQ(declared.split("Section (a/b)/After the section"), (ParameterPath{"Section (a/b)", "After the section"}));
}

TEST(DeclaredParameters, ListingCanBeReadBack)
{
  dealii::ParameterHandler prm;
  declare(prm);
  prm.set("Alpha", "b");
  std::ostringstream listing;
  DeclaredParameters(prm).print(listing);
  EXPECT_NE(listing.str().find("# Default: a\nset Alpha = b\n"), std::string::npos) << listing.str();
  EXPECT_NE(listing.str().find("  # Declared after it [m].\n  # Allowed: a number from 0 to 1\n"), std::string::npos);

  const std::string file =
    (std::filesystem::temp_directory_path() / ("alluvium-listing-" + std::to_string(getpid()) + ".prm")).string();
  std::ofstream(file) << listing.str();
  dealii::ParameterHandler again, by_deal_ii;
  declare(again);
  apply_statements(again, read_statements(file));
  std::ostringstream second;
  DeclaredParameters(again).print(second);
  EXPECT_EQ(listing.str(), second.str());

  declare(by_deal_ii);
  EXPECT_NO_THROW(by_deal_ii.parse_input(file));
  EXPECT_EQ(by_deal_ii.get("Alpha"), "b");
  std::filesystem::remove(file);
}
