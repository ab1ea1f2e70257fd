// Plug-ins chosen by name: which instance the parameters reach.
#include <alluvium/utilities/plugin.h>

#include <deal.II/base/parameter_handler.h>

#include <gtest/gtest.h>

using namespace alluvium;
using dealii::ParameterHandler;

namespace
{
  struct Shape
  {
    virtual ~Shape() = default;
    virtual void   add_parameters(ParameterHandler &) {}
    virtual double area() const = 0;
  };

  struct Square : Shape
  {
    void   add_parameters(ParameterHandler &prm) override { prm.add_parameter("Side", side, "[m]"); }
    double area() const override { return side * side; }
    double side = 1.;
  };

  ALLUVIUM_REGISTER(Shape, Square, "square", "Of one side.")

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

// Of two plug-ins with one name the first would be used, without a word.
TEST(PluginChoice, ANameTakenTwiceIsSaid)
{
  struct Colour
  {
    virtual ~Colour() = default;
    void add_parameters(ParameterHandler &) {}
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
