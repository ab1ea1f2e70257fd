#include <alluvium/output/summary.h>
#include <alluvium/utilities/user_error.h>

#include <deal.II/base/exceptions.h>

#include "fixtures/folder_fixture.h"

#include <cmath>
#include <limits>

using alluvium::UserError;
using alluvium::output::Summary;

namespace
{
  class SummaryTest : public FolderFixture
  {
  };
} // namespace

TEST_F(SummaryTest, NestsAndKeepsTheOrder)
{
  Summary summary(path("summary.json"), MPI_COMM_SELF);
  summary.set("scene", "bed");
  summary.set("timing/fluid solve_s", 1.5);
  summary.set("timing/contacts_s", 0.5);
  summary.set("grains", 2000u);
  summary.set("finished", true);
  summary.set("heave/time_s", std::numeric_limits<double>::quiet_NaN());
  summary.set("profile", std::vector<double>{1., 2.});
  summary.set("scene", std::string("bed two"));
  summary.warn("coarse");
  summary.warn("coarse");
  summary.write();
  EXPECT_EQ(read("summary.json"),
            "{\n"
            "  \"scene\": \"bed two\",\n"
            "  \"timing\": {\n"
            "    \"fluid solve_s\": 1.5,\n"
            "    \"contacts_s\": 0.5\n"
            "  },\n"
            "  \"grains\": 2000,\n"
            "  \"finished\": true,\n"
            "  \"heave\": {\n"
            "    \"time_s\": null\n"
            "  },\n"
            "  \"profile\": [\n"
            "    1.0,\n"
            "    2.0\n"
            "  ],\n"
            "  \"warnings\": [\n"
            "    \"coarse\"\n"
            "  ]\n"
            "}\n");
  EXPECT_EQ(n_files(), 1u); // no temporary left
  EXPECT_THROW(summary.set("grains/of sand", 1.), dealii::ExceptionBase);
}

TEST_F(SummaryTest, Resumes)
{
  {
    Summary summary(path("summary.json"), MPI_COMM_SELF);
    summary.resume(); // nothing there yet
    summary.set("first movement/time_s", 0.69);
    summary.set("name", "x");
    summary.warn("one");
    summary.write();
  }
  Summary summary(path("summary.json"), MPI_COMM_SELF);
  summary.resume();
  EXPECT_TRUE(summary.has("first movement/time_s"));
  EXPECT_FALSE(summary.has("first movement/head_m"));
  EXPECT_EQ(summary.number("first movement/time_s"), 0.69);
  EXPECT_TRUE(std::isnan(summary.number("name")));
  EXPECT_TRUE(std::isnan(summary.number("no/such/thing")));
  summary.warn("two");
  summary.write();
  EXPECT_NE(read("summary.json").find("\"one\",\n    \"two\""), std::string::npos);

  write("broken.json", "{\"a\": ");
  Summary broken(path("broken.json"), MPI_COMM_SELF);
  EXPECT_THROW(broken.resume(), UserError);
}

TEST_F(SummaryTest, SaysIfItCannotWrite)
{
  const Summary summary(path("no/summary.json"), MPI_COMM_SELF);
  EXPECT_NE(complaint<UserError>([&] { summary.write(); }).find("No such file"), std::string::npos);
}
