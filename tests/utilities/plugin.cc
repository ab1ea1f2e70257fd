// Plug-ins chosen by name: which instance the parameters reach.
#include <alluvium/utilities/plugin.h>

#include <deal.II/base/parameter_handler.h>

#include <gtest/gtest.h>

using namespace alluvium;
using dealii::ParameterHandler;

namespace
{
  struct Shape : Plugin
  {
    virtual double area() const = 0;
  };

  struct Square : Shape
  {
    void add_parameters(ParameterHandler &prm) override { prm.add_parameter("Side", side, "[m]"); }
    void parse_parameters() override
    {
      check_user(side > 0., "A square needs a side.");
      ++n_parsed;
    }
    double       area() const override { return side * side; }
    double       side     = 1.;
    unsigned int n_parsed = 0;
  };

  /** Others together; which, a parameter says. */
  struct Sum : Shape, Composite<Shape>
  {
    void                     add_parameters(ParameterHandler &prm) override { prm.add_parameter("Of", of, "Names."); }
    std::vector<std::string> parts() const override { return dealii::Utilities::split_string_list(of); }
    double                   area() const override
    {
      double sum = 0.;
      for (const std::string &name : parts())
        sum += part(name).area();
      return sum;
    }
    std::string of = "square";
  };

  struct Twice : Shape, Composite<Shape>
  {
    std::vector<std::string> parts() const override { return {"sum"}; }
    double                   area() const override { return 2. * part("sum").area(); }
  };

  ALLUVIUM_REGISTER(Shape, Square, "square", "Of one side.")
  ALLUVIUM_REGISTER(Shape, Sum, "sum", "Of others.")
  ALLUVIUM_REGISTER(Shape, Twice, "twice", "The sum, twice.")

  /** Declare the choice in @p prm. */
  void declare(PluginChoice<Shape> &choice, ParameterHandler &prm)
  {
    choice.add_parameters(prm, "Shape", "square", "Which.");
  }

  void set_side(ParameterHandler &prm, const std::string &side)
  {
    prm.enter_subsection("Shape: square");
    prm.set("Side", side);
    prm.leave_subsection();
  }
} // namespace

// Parameter handlers write into what they are bound to: both of them into the instance that is used.
TEST(PluginChoice, ASecondHandlerReachesTheInstanceInUse)
{
  PluginChoice<Shape> choice;
  ParameterHandler    first, second;
  declare(choice, first);
  set_side(first, "2");
  EXPECT_EQ(choice.get().area(), 4.);
  const Shape *const in_use = &choice.get();
  declare(choice, second);
  EXPECT_EQ(&choice.get(), in_use);
  set_side(second, "3");
  EXPECT_EQ(choice.get().area(), 9.);
  set_side(first, "5");
  EXPECT_EQ(choice.get().area(), 25.);
}

// A plug-in that uses others has them with what the user set in their sections, also through others that do so.
TEST(PluginChoice, CompositesShareTheParametersOfTheirParts)
{
  PluginChoice<Shape> choice;
  ParameterHandler    prm;
  choice.add_parameters(prm, "Shape", "twice", "Which.");
  set_side(prm, "3");
  choice.parse_parameters();
  EXPECT_EQ(choice.get().area(), 18.);
  // they are parsed as those that are chosen, and only then
  EXPECT_EQ(dynamic_cast<Square &>(choice.get("square")).n_parsed, 1u);
  set_side(prm, "0");
  EXPECT_THROW(choice.parse_parameters(), UserError);
  prm.enter_subsection("Shape: sum");
  prm.set("Of", "");
  prm.leave_subsection();
  EXPECT_NO_THROW(choice.parse_parameters());
  EXPECT_EQ(choice.get().area(), 0.);
}

TEST(PluginChoice, WrongPartsAreNamed)
{
  const auto message = [](const std::string &of) -> std::string {
    PluginChoice<Shape> choice;
    ParameterHandler    prm;
    choice.add_parameters(prm, "Shape", "sum", "Which.");
    prm.enter_subsection("Shape: sum");
    prm.set("Of", of);
    prm.leave_subsection();
    try
      {
        choice.parse_parameters();
      }
    catch (const UserError &e)
      {
        return e.what();
      }
    return "";
  };
  EXPECT_EQ(message("square, square"), "");
  EXPECT_EQ(message("square, disc"), "'sum' uses 'disc', but there is no plug-in of this name.");
  EXPECT_EQ(message("twice"), "'twice' uses 'sum', which uses 'twice'."); // nor may they go round in circles
}

// Of two plug-ins with one name the first would be used, without a word.
TEST(PluginChoice, ANameTakenTwiceIsSaid)
{
  struct Colour : Plugin
  {
  };
  const auto create = [] { return std::make_unique<Colour>(); };
  EXPECT_TRUE(Registry<Colour>::add("red", "As blood.", create));
  ParameterHandler prm;
  PluginChoice<Colour>().add_parameters(prm, "Colour", "red", "Which.");
  EXPECT_FALSE(Registry<Colour>::add("red", "As a rose.", create));
  try
    {
      PluginChoice<Colour>().add_parameters(prm, "Colour", "red", "Which.");
      FAIL() << "accepted";
    }
  catch (const UserError &e)
    {
      EXPECT_NE(std::string(e.what()).find("'red'"), std::string::npos) << e.what();
    }
}
