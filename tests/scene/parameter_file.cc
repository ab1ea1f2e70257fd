#include <alluvium/scene/parameter_file.h>
#include <alluvium/utilities/user_error.h>

#include <deal.II/base/parameter_handler.h>

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>

#include <unistd.h>

using namespace alluvium;
using namespace alluvium::scene;

namespace
{
  /** A folder to write parameter files in, and some parameters to read. */
  class ParameterFile : public ::testing::Test
  {
  protected:
    ParameterFile()
      : folder(std::filesystem::temp_directory_path() / ("alluvium-parameter-file-" + std::to_string(getpid())))
    {
      std::filesystem::create_directories(folder);

      declare_method(prm);
      prm.add_parameter("Title", title, "What to print.");
      prm.enter_subsection("Fluid");
      prm.add_parameter("Density", density, "Density [kg/m^3].", dealii::Patterns::Double(0));
      prm.add_parameter("Viscosity", viscosity, "Dynamic viscosity [Pa s].", dealii::Patterns::Double(0));
      prm.declare_alias("Viscosity", "Stickiness");
      prm.enter_subsection("Solver: gmres");
      prm.add_parameter("Iterations", iterations, "At most so many.", dealii::Patterns::Integer(1, 500));
      prm.leave_subsection();
      prm.leave_subsection();
      prm.enter_subsection("Grains");
      prm.add_parameter("Radius", radius, "Radius [m].", dealii::Patterns::Double(0));
      prm.add_parameter("Drag law", drag_law, "Which.", dealii::Patterns::Selection("disc|sphere|paper"));
      prm.add_parameter("Ratio a/b", ratio, "A name with a slash.");
      prm.add_parameter("Gravity", gravity, "Two numbers [m/s^2].");
      prm.add_parameter("Rolls", rolls, "Or slides.");
      prm.add_parameter("Friction of walls", friction, "As `name: value, ...` [-].");
      prm.add_parameter("Observers", observers, "Some.", dealii::Patterns::MultipleSelection("bed|flux|head"));
      prm.leave_subsection();
    }

    ~ParameterFile() override { std::filesystem::remove_all(folder); }

    std::string write(const std::string &name, const std::string &text)
    {
      const auto file = folder / name;
      std::filesystem::create_directories(file.parent_path());
      std::ofstream(file) << text;
      return file.string();
    }

    std::vector<std::string> read(const std::string &text, const std::vector<std::string> &assignments = {})
    {
      return read_parameters(
               prm, write("scene.prm", text), assignments, {{"Grains/Drag law", "paper"}, {"Grains/Radius", "7"}})
        .warnings;
    }

    std::string without_folder(std::string message) const
    {
      const std::string name = folder.string() + "/";
      for (auto at = message.find(name); at != std::string::npos; at = message.find(name))
        message.erase(at, name.size());
      return message;
    }

    /** The message of the error, without the folder. */
    std::string error(const std::string &text, const std::vector<std::string> &assignments = {})
    {
      try
        {
          read(text, assignments);
        }
      catch (const UserError &user_error)
        {
          return without_folder(user_error.what());
        }
      return "no error";
    }

    dealii::ParameterHandler prm;
    std::string              title;
    double                   density = 1000., viscosity = 1e-3, radius = 1e-4, ratio = 1.;
    int                      iterations = 10;
    std::string              drag_law   = "disc";
    std::vector<double>      gravity    = {0., -9.81};
    bool                     rolls      = true;

    std::map<std::string, double> friction;
    std::string                   observers = "bed, flux";
    std::filesystem::path         folder;
  };
} // namespace


TEST_F(ParameterFile, ReadsTheLanguage)
{
  read("# a comment\n"
       "set Title = one \\\n"
       "            two   # another\n"
       "\n"
       "subsection Fluid\r\n"
       "  set Density=1.2\r\n"
       "\tsubsection Solver: gmres\n"
       "    SET Iterations = 20\n"
       "  end\n"
       "END\n"
       "subsection Grains\n"
       "  set Ratio a/b = 2\n"
       "  set Gravity   = 1, -2\n"
       "end");
  EXPECT_EQ(title, "one two");
  EXPECT_EQ(density, 1.2);
  EXPECT_EQ(iterations, 20);
  EXPECT_EQ(ratio, 2.);
  EXPECT_EQ(gravity, (std::vector<double>{1., -2.}));
  EXPECT_EQ(viscosity, 1e-3);
}

TEST_F(ParameterFile, IncludesFilesBesideTheIncludingOne)
{
  write("parts/fluid.prm", "set Density = 5\ninclude more.prm\n");
  write("parts/more.prm", "set Viscosity = 6\n");
  read("subsection Fluid\n include parts/fluid.prm\nend\n");
  EXPECT_EQ(density, 5.);
  EXPECT_EQ(viscosity, 6.);

  write("parts/more.prm", "\nset Viscocity = 6\n");
  EXPECT_EQ(error("subsection Fluid\n include parts/fluid.prm\nend\n"),
            "parts/more.prm:2: there is no parameter 'Viscocity' in section 'Fluid'; did you mean 'Viscosity'?");
  EXPECT_EQ(error("\ninclude nothing.prm\n"), "scene.prm:2: There is no parameter file 'nothing.prm'.");
  EXPECT_EQ(error("include scene.prm\n"), "scene.prm:1: 'scene.prm' includes itself.");
  write("parts/open.prm", "subsection Grains\n");
  EXPECT_EQ(error("include parts/open.prm\nend"), "parts/open.prm:1: subsection 'Grains' is never closed by an 'end'.");
  write("parts/closes.prm", "end\n");
  EXPECT_EQ(error("subsection Fluid\ninclude parts/closes.prm"),
            "parts/closes.prm:1: there is no open subsection for this 'end' to close.");
}

TEST_F(ParameterFile, SettingTwiceInOneFileIsSaid)
{
  const auto warnings = read("subsection Fluid\n set Density = 1\nend\nsubsection Fluid\n set Density = 2\nend\n");
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(without_folder(warnings[0]),
            "scene.prm:5: parameter 'Fluid/Density' is set twice in this file: '2' overrides the '1' of line 2. Delete "
            "one of the lines.");
  EXPECT_EQ(density, 2.);

  // an old name is the same parameter
  const auto renamed = read("subsection Fluid\nset Stickiness = 1\nset Viscosity = 2\nend\n");
  ASSERT_EQ(renamed.size(), 1u);
  EXPECT_EQ(
    without_folder(renamed[0]),
    "scene.prm:3: parameter 'Fluid/Viscosity' is set twice in this file: '2' overrides the '1' of line 2, where "
    "it is called 'Stickiness'. Delete one of the lines.");
  EXPECT_EQ(viscosity, 2.);

  // what an included file says is there to be overridden, as by the command line; and a file may be included twice
  write("base.prm", "subsection Fluid\n set Density = 1\nend\n");
  EXPECT_TRUE(read("include base.prm\nsubsection Fluid\n set Density = 2\nend\n", {"Fluid/Density=3"}).empty());
  EXPECT_EQ(density, 3.);
  EXPECT_TRUE(read("include base.prm\ninclude base.prm\n").empty());
  EXPECT_TRUE(read("set Title = a\nsubsection Fluid\n set Density = 1\nend\n").empty());
  // but not by the including file twice
  EXPECT_EQ(read("set Title = a\ninclude base.prm\nset Title = b\n").size(), 1u);
}

TEST_F(ParameterFile, FileErrors)
{
  EXPECT_THROW(read_statements((folder / "missing.prm").string()), UserError);
  EXPECT_THROW(read_statements(folder.string()), UserError);
}

TEST_F(ParameterFile, SyntaxErrors)
{
  EXPECT_EQ(error("subsection Fluid\nset Density = 1\n"),
            "scene.prm:1: subsection 'Fluid' is never closed by an 'end'.");
  EXPECT_EQ(error("\nend\n"), "scene.prm:2: there is no open subsection for this 'end' to close.");
  EXPECT_EQ(error("set Title\n"), "scene.prm:1: expected 'set NAME = VALUE', found 'set Title'.");
  EXPECT_EQ(error("set = 3\n"), "scene.prm:1: expected 'set NAME = VALUE', found 'set = 3'.");
  EXPECT_EQ(error("ste Title = 3\n"), "scene.prm:1: cannot understand 'ste Title = 3'; did you mean 'set'?");
  EXPECT_EQ(error("subsection\n"), "scene.prm:1: 'subsection' needs a name.");
  EXPECT_EQ(error("subsection Fluid\nend Fluid"), "scene.prm:2: nothing may follow 'end', but 'Fluid' does.");
  EXPECT_EQ(error("set Title = a \\"), "scene.prm:1: the last line ends with a '\\' that nothing follows.");
}

TEST_F(ParameterFile, UnknownNames)
{
  EXPECT_EQ(error("subsection Fluid\n  set Densiyt = 1\nend\n"),
            "scene.prm:2: there is no parameter 'Densiyt' in section 'Fluid'; did you mean 'Density'?");
  EXPECT_EQ(error("subsection Fluid\n  set Radius = 1\nend\n"),
            "scene.prm:2: there is no parameter 'Radius' in section 'Fluid'; there is one in section 'Grains'");
  EXPECT_EQ(error("set Density = 1\n"),
            "scene.prm:1: there is no parameter 'Density' outside of all sections; there is one in section 'Fluid'");
  EXPECT_EQ(
    error("subsection Fluid\n  set Raduis = 1\nend\n"),
    "scene.prm:2: there is no parameter 'Raduis' in section 'Fluid'; did you mean 'Radius' in section 'Grains'?");
  EXPECT_EQ(error("subsection Fluid\n  set Permeability = 1\nend\n"),
            "scene.prm:2: there is no parameter 'Permeability' in section 'Fluid'; it has: 'Density', 'Viscosity'");
  EXPECT_EQ(error("subsection Fliud\n  set Density = 1\n set Viscosity = 3\nend\n"),
            "scene.prm:1: there is no section 'Fliud' outside of all sections; did you mean 'Fluid'?");
  EXPECT_EQ(error("subsection Solver: gmres\n  set Iterations = 3\nend\n"),
            "scene.prm:1: there is no section 'Solver: gmres' outside of all sections; did you mean 'Solver: gmres' in "
            "section 'Fluid'?");
  EXPECT_EQ(error("set Fluid = 1\n"),
            "scene.prm:1: there is no parameter 'Fluid' outside of all sections; that is a section: write 'subsection "
            "Fluid'");
}

TEST_F(ParameterFile, BadValues)
{
  EXPECT_EQ(error("subsection Fluid\n  set Density = -1\nend\n"),
            "scene.prm:2: parameter 'Fluid/Density' cannot be '-1': expected a number >= 0.");
  EXPECT_EQ(error("subsection Fluid\n  set Density = heavy\nend\n"),
            "scene.prm:2: parameter 'Fluid/Density' cannot be 'heavy': expected a number >= 0.");
  EXPECT_EQ(error("subsection Fluid\n  set Density = \nend\n"),
            "scene.prm:2: parameter 'Fluid/Density' has no value: expected a number >= 0.");
  EXPECT_EQ(error("subsection Fluid\nsubsection Solver: gmres\nset Iterations = 0\nend\nend\n"),
            "scene.prm:3: parameter 'Fluid/Solver: gmres/Iterations' cannot be '0': expected a whole number from 1 to "
            "500.");
  EXPECT_EQ(
    error("subsection Grains\n  set Drag law = shpere\nend\n"),
    "scene.prm:2: parameter 'Grains/Drag law' cannot be 'shpere': expected one of: disc, sphere, paper. Did you "
    "mean 'sphere'?");
  EXPECT_EQ(error("subsection Grains\n  set Rolls = perhaps\nend\n"),
            "scene.prm:2: parameter 'Grains/Rolls' cannot be 'perhaps': expected true or false.");
  EXPECT_EQ(error("subsection Grains\n  set Gravity = 1 2\nend\n"),
            "scene.prm:2: parameter 'Grains/Gravity' cannot be '1 2': expected any number of values separated by "
            "commas, each a number.");
  EXPECT_EQ(error("# gr\xFC\xDF"              // comments may be anything
                  "e\nset Title = gr\xFC\xDF" // of Latin 1
                  "e\n"),
            "scene.prm:2: the value of 'Title' has characters that are not UTF-8; save the file as UTF-8.");
}

TEST_F(ParameterFile, ANameStandsOnceInAList)
{
  const std::string twice = R"(scene.prm:2: parameter 'Grains/Friction of walls' has 'bottom' twice)";
  for (const std::string value : {"bottom: 0, bottom: 0.9", "bottom: 0.9, top: 1, bottom : 0.9"})
    EXPECT_NE(error("subsection Grains\nset Friction of walls = " + value + "\nend\n").find(twice), std::string::npos)
      << value;
  EXPECT_NE(error("subsection Grains\nset Observers = bed, head, bed\nend\n").find("'bed' twice"), std::string::npos);
  read("subsection Grains\nset Friction of walls = bottom: 0, top: 0\nset Observers = head, bed\nend\n");
  EXPECT_EQ(friction.size(), 2u);
}

TEST_F(ParameterFile, ListsAllMistakesAndSetsNothing)
{
  EXPECT_EQ(
    error("set Titel = x\nsubsection Fluid\n  set Density = 3\n  set Viscosity = thick\nend\n", {"Fluid/Densty=4"}),
    "scene.prm:1: there is no parameter 'Titel' outside of all sections; did you mean 'Title'?\n"
    "scene.prm:4: parameter 'Fluid/Viscosity' cannot be 'thick': expected a number >= 0.\n"
    "--set 'Fluid/Densty=4': there is no parameter 'Densty' in section 'Fluid'; did you mean 'Density'?");
  EXPECT_EQ(density, 1000.);
}

TEST_F(ParameterFile, CommandLineOverridesTheFile)
{
  read("subsection Fluid\n  set Density = 3\n set Viscosity = 2\nend\n",
       {"Fluid/Density=4", "Fluid / Solver: gmres / Iterations = 7", "Grains/Ratio a/b=3", "Title=a=b"});
  EXPECT_EQ(density, 4.);
  EXPECT_EQ(viscosity, 2.);
  EXPECT_EQ(iterations, 7);
  EXPECT_EQ(ratio, 3.);
  EXPECT_EQ(title, "a=b");
  EXPECT_EQ(error("", {"Fluid/Density"}), "--set 'Fluid/Density': expected --set 'Section/Name=value'.");
  EXPECT_EQ(error("", {"Fluid/Density=x"}),
            "--set 'Fluid/Density=x': parameter 'Fluid/Density' cannot be 'x': expected a number >= 0.");
}

TEST_F(ParameterFile, MethodChangesDefaultsOnly)
{
  read("subsection Grains\n  set Radius = 3\nend\nset Method = paper\n");
  EXPECT_EQ(drag_law, "paper");
  EXPECT_EQ(radius, 3.);
}

TEST_F(ParameterFile, MethodFromTheCommandLine)
{
  read("set Method = paper\n", {"Method=default"});
  EXPECT_EQ(drag_law, "disc");
  read("", {"Method=paper"});
  EXPECT_EQ(drag_law, "paper");
  EXPECT_EQ(
    error("set Method = papers\n"),
    "scene.prm:1: parameter 'Method' cannot be 'papers': expected one of: default, paper. Did you mean 'paper'?");
}

TEST_F(ParameterFile, OldNamesStillWork)
{
  prm.enter_subsection("Fluid");
  prm.declare_alias("Density", "Rho");
  prm.leave_subsection();
  read("subsection Fluid\n  set Rho = 3\nend\n");
  EXPECT_EQ(density, 3.);
  EXPECT_NE(error("subsection Fluid\n  set Rho = x\nend\n").find("scene.prm:2"), std::string::npos);
}

TEST_F(ParameterFile, NumbersBeyondAllSizesAreRefused)
{
  for (const char *value : {"1e300", "1e31", "1e-31"})
    EXPECT_EQ(error(std::string("subsection Fluid\n set Density = ") + value + "\nend"),
              std::string("scene.prm:2: parameter 'Fluid/Density' cannot be '") + value +
                "': expected a number >= 0, of a size from 1e-30 to 1e30 if it is not 0.");
  EXPECT_NE(error("subsection Grains\n set Gravity = 0, -1e300\nend").find("of a size from"), std::string::npos);
  EXPECT_EQ(error("subsection Fluid\n set Density = 0\nend"), "no error");
  EXPECT_EQ(error("subsection Fluid\n set Density = 1e30\nend"), "no error");
  EXPECT_EQ(error("set Title = 1e300"), "no error");
}
