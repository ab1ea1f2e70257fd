#include <alluvium/scene/accuracy.h>
#include <alluvium/utilities/user_error.h>

#include <deal.II/base/parameter_handler.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

using namespace alluvium;
using namespace alluvium::scene;

namespace
{
  /** The parameters that decide the kind of a scene and those that `Accuracy` chooses, with their defaults. */
  class Accuracy : public ::testing::Test
  {
  protected:
    Accuracy()
    {
      declare_method(prm);
      declare_accuracy(prm);
      for (const auto &[name, value] : std::map<std::string, std::string>{{"Gravity", "0, -9.81"},
                                                                           {"Fluid/Model", "volume-averaged"},
                                                                           {"Fluid/Body force", "0 | 0"},
                                                                           {"Fluid/Mean pressure gradient", "0 | 0"},
                                                                           {"Grains/Deposit", "settled bed"},
                                                                           {"Grains/Fixed", "false"},
                                                                           {"Coupling/Time scheme", "iterated"},
                                                                           {"Grains/Deposit: settled bed/Box", ""},
                                                                           {"Domain/Mesh file", ""},
                                                                           {"Boundary conditions/Pressure", "top: 0; bottom: 1"},
                                                                           {"Boundary conditions/Velocity", ""},
                                                                           {"Boundary conditions/Plug-ins", ""}})
        declare(name, value);
      for (const auto &choice : accuracy_choices())
        for (const auto &[name, value] : choice.values)
          if (!default_of.count(name))
            declare(name, "as before");
    }

    void declare(const std::string &name, const std::string &value)
    {
      default_of[name] = value;
      std::size_t              from = 0, depth = 0;
      for (std::size_t to; (to = name.find('/', from)) != std::string::npos; from = to + 1, ++depth)
        prm.enter_subsection(name.substr(from, to - from));
      prm.declare_entry(name.substr(from), value);
      for (; depth > 0; --depth)
        prm.leave_subsection();
    }

    /** Read a scene that sets these, and nothing else. */
    std::vector<std::string> read(const std::vector<std::string> &assignments)
    {
      return read_parameters(prm, "", assignments, {{"Coupling/Filter radius", "grain"}}).choices;
    }

    std::string value(const std::string &name) const
    {
      const DeclaredParameters declared(prm);
      return declared.find(declared.split(name))->value;
    }

    std::string kind(const std::map<std::string, std::string> &own) const
    {
      return find_accuracy_kind([&](const std::string &name) { return own.count(name) ? own.at(name) : default_of.at(name); }).name;
    }

    static bool has(const std::vector<std::string> &lines, const std::string &text)
    {
      return std::any_of(
        lines.begin(), lines.end(), [&](const std::string &line) { return line.find(text) != std::string::npos; });
    }

    dealii::ParameterHandler           prm;
    std::map<std::string, std::string> default_of;
  };
} // namespace


TEST_F(Accuracy, OffChangesNothing)
{
  EXPECT_TRUE(read({}).empty());
  for (const auto &[name, value_before] : default_of)
    EXPECT_EQ(value(name), value_before) << name;
}

TEST_F(Accuracy, IsThatOfAnAutomaticModelToo)
{
  declare("Model", "full");
  declare("Automatic model/Accuracy", "0.01");
  read({"Accuracy=10 %"});
  EXPECT_EQ(value("Automatic model/Accuracy"), "0.01");
  EXPECT_TRUE(has(read({"Accuracy=10 %", "Model=auto"}), "model: Automatic model/Accuracy = 0.1"));
  EXPECT_EQ(value("Automatic model/Accuracy"), "0.1");
  read({"Accuracy=10 %", "Model=auto", "Automatic model/Accuracy=0.5"});
  EXPECT_EQ(value("Automatic model/Accuracy"), "0.5");
}

TEST_F(Accuracy, HasEveryKindAndAccuracy)
{
  std::map<std::string, std::set<std::string>> groups;
  for (const auto &choice : accuracy_choices())
    {
      ASSERT_FALSE(choice.values.empty());
      EXPECT_TRUE(groups[choice.kind + ", " + choice.accuracy].insert(choice.group).second)
        << choice.kind << ", " << choice.accuracy << ": " << choice.group << " twice";
      EXPECT_FALSE(choice.reason.empty());
    }
  for (auto &[name, found] : groups)
    found.erase("filter"); // that of the default, but for the finest cells
  for (const std::string accuracy : {"10 %", "1 %", "0.1 %"})
    {
      EXPECT_EQ(groups["dry, " + accuracy], (std::set<std::string>{"time step", "contacts"}));
      for (const std::string kind : {"bed, ", "suspension, ", "other, "})
        EXPECT_EQ(groups[kind + accuracy],
                  (std::set<std::string>{"time step", "contacts", "coupling", "linear solver", "cells"}));
    }
}

TEST_F(Accuracy, SetsWhatItSays)
{
  const auto lines = read({"Accuracy=1 %"});
  for (const auto &choice : accuracy_choices())
    if (choice.kind == "bed" && choice.accuracy == "1 %")
      for (const auto &[name, wanted] : choice.values)
        {
          EXPECT_EQ(value(name), wanted) << name;
          EXPECT_TRUE(has(lines, choice.group + ": ")) << choice.group;
          EXPECT_TRUE(has(lines, name + " = " + wanted)) << name;
          EXPECT_TRUE(has(lines, choice.reason)) << choice.reason;
        }
  EXPECT_EQ(value("Mesh refinement/Criteria"), "bed faces");
  EXPECT_EQ(value("Mesh refinement/Criteria: uniform/Cell size"), "as before");
  EXPECT_EQ(lines[0].rfind("1 %, ", 0), 0u);
}

TEST_F(Accuracy, TheScenesOwnSettingsWin)
{
  const std::string tolerance = "Time/Automatic time step/Tolerance", faces = "Mesh refinement/Criteria: bed faces/",
                    sweep = "Contacts/Residual tolerance";
  // what leads a group takes the others with it
  auto lines = read({"Accuracy=1 %", "Time/Time step=1e-3", sweep + "=1e-7"});
  EXPECT_EQ(value("Time/Time step"), "1e-3");
  EXPECT_EQ(value(tolerance), "as before");
  EXPECT_EQ(value(sweep), "1e-7");
  EXPECT_EQ(value("Contacts/Largest violation"), "as before");
  EXPECT_TRUE(has(lines, "time step: as the scene has them: Time/Time step = 1e-3 (--set 'Time/Time step=1e-3')"));
  EXPECT_NE(value("Fluid/Linear solver/Tolerance"), "as before");
  // unless it is what would be chosen
  read({"Accuracy=1 %", "Time/Time step=auto"});
  EXPECT_NE(value(tolerance), "as before");
  // one of the others does not
  lines = read({"Accuracy=1 %", faces + "Cell size at the top=3", tolerance + "=0.5"});
  EXPECT_EQ(value(faces + "Cell size at the top"), "3");
  EXPECT_NE(value(faces + "Cell size at the bottom"), "3");
  EXPECT_EQ(value(tolerance), "0.5");
  EXPECT_EQ(value("Time/Time step"), "auto");
  EXPECT_TRUE(has(lines, tolerance + " = 0.5 (--set '" + tolerance + "=0.5')"));
}

TEST_F(Accuracy, ChoosesAFilterForFineCells)
{
  read({"Accuracy=0.1 %"});
  EXPECT_EQ(value("Coupling/Filter radius"), "2.5 d");
  EXPECT_EQ(value("Coupling/Filter shape"), "smooth");
}

TEST_F(Accuracy, AFilterOfTheScenesOwnStaysWhole)
{
  read({"Accuracy=0.1 %", "Coupling/Filter radius=2 d"});
  EXPECT_EQ(value("Coupling/Filter radius"), "2 d");
  EXPECT_EQ(value("Coupling/Filter shape"), "as before");
  EXPECT_EQ(value("Mesh refinement/Criteria"), "bed faces");
}

TEST_F(Accuracy, LeavesOutWhatIsOfNoUse)
{
  const std::string contacts = "Contacts/Residual tolerance", coupling = "Coupling/Time scheme: iterated/Tolerance";
  EXPECT_FALSE(has(read({"Accuracy=1 %", "Coupling/Time scheme=explicit"}), "coupling: "));
  EXPECT_EQ(value(coupling), "as before");
  EXPECT_NE(value(contacts), "as before");
}

TEST_F(Accuracy, FixedGrainsHaveNoContacts)
{
  const auto lines = read({"Accuracy=1 %", "Grains/Fixed=true"});
  EXPECT_FALSE(has(lines, "contacts: ") || has(lines, "coupling: "));
  EXPECT_TRUE(has(lines, "time step: "));
}

TEST_F(Accuracy, CellsOfAMeshFileStay)
{
  const auto lines = read({"Accuracy=1 %", "Domain/Mesh file=pile.msh"});
  EXPECT_EQ(value("Mesh refinement/Criteria"), "as before");
  EXPECT_EQ(value("Time/Time step"), "auto");
  EXPECT_TRUE(has(lines, "cells: those of Domain/Mesh file, pile.msh"));
}

TEST_F(Accuracy, CellsWithoutGrainsStay)
{
  const auto lines = read({"Accuracy=1 %", "Grains/Deposit=none"});
  EXPECT_EQ(value("Mesh refinement/Criteria"), "as before");
  EXPECT_TRUE(has(lines, "there is no grain"));
}

TEST_F(Accuracy, TheMethodOfThePaperKeepsItsChoices)
{
  read({"Accuracy=0.1 %", "Method=paper"});
  EXPECT_EQ(value("Coupling/Filter radius"), "grain");
  EXPECT_EQ(value("Time/Time step"), "auto");
}

TEST_F(Accuracy, RefusesOtherValues)
{
  EXPECT_THROW(read({"Accuracy=5 %"}), UserError);
  EXPECT_EQ(value("Time/Time step"), "as before");
}

TEST_F(Accuracy, TellsKindsOfScenes)
{
  const std::string pressure = "Boundary conditions/Pressure", velocity = "Boundary conditions/Velocity";
  EXPECT_EQ(kind({{"Fluid/Model", "none"}}), "dry");
  EXPECT_EQ(kind({}), "bed");
  EXPECT_EQ(kind({{pressure, "top: 0; bottom: rho*g*H*(1 + t)"}}), "bed");
  EXPECT_EQ(kind({{pressure, "top: 0"}, {velocity, "bottom: 0 | 0.01*t"}}), "bed");
  EXPECT_EQ(kind({{"Gravity", "9.81, 0.1"}, {pressure, "left: 0; right: 9"}}), "bed");
  EXPECT_EQ(kind({{"Grains/Deposit", "random suspension"}}), "suspension");
  for (const std::string deposit : {"lattice", "file", "end of a run", "none"})
    EXPECT_EQ(kind({{"Grains/Deposit", deposit}}), "other") << deposit;
  EXPECT_EQ(kind({{"Grains/Deposit: settled bed/Box", "0, 0, 1, 1"}}), "other");
  EXPECT_EQ(kind({{pressure, "top: 0"}, {velocity, "slot: 0 | 0.05"}}), "other"); // a jet
  EXPECT_EQ(kind({{pressure, "left: 9; right: 0"}}), "other");
  EXPECT_EQ(kind({{"Gravity", "9.81, 0"}}), "other");
  EXPECT_EQ(kind({{pressure, "top: 0"}}), "other"); // nothing goes through the bed
  EXPECT_EQ(kind({{pressure, ""}}), "other");
  EXPECT_EQ(kind({{pressure, "bottom: 1"}, {velocity, "top: 0.5*min(1, t/0.1) | 0"}}), "other"); // a lid that moves
  EXPECT_EQ(kind({{pressure, "bottom: 1"}, {"Boundary conditions/Plug-ins", "top: free"}}), "bed");
  EXPECT_EQ(kind({{"Fluid/Body force", "rho*0.5 | 0"}}), "other");
  EXPECT_EQ(kind({{"Fluid/Mean pressure gradient", "-500 | 0"}}), "other");
}
