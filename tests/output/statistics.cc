#include <alluvium/output/statistics.h>
#include <alluvium/utilities/user_error.h>

#include <deal.II/base/exceptions.h>

#include "fixtures/folder_fixture.h"

using alluvium::UserError;
using alluvium::output::Statistics;

namespace
{
  class StatisticsTest : public FolderFixture
  {
  protected:
    Statistics make(const unsigned int precision = 10)
    {
      Statistics statistics(path("statistics.csv"), MPI_COMM_SELF, precision);
      statistics.add_column("time_s");
      statistics.add_column("differential_head_m");
      return statistics;
    }

    void write_rows(Statistics &statistics, const double start, const int n)
    {
      for (int i = 0; i < n; ++i)
        {
          statistics.set("time_s", start + 0.1 * i);
          statistics.set("differential_head_m", 10 * (start + 0.1 * i));
          statistics.write_row();
        }
    }
  };
} // namespace

TEST_F(StatisticsTest, WritesOneHeaderAndRowsAtOnce)
{
  auto statistics = make();
  EXPECT_EQ(n_files(), 0u); // nothing before the first row
  write_rows(statistics, 0., 1);
  EXPECT_EQ(read("statistics.csv"), "time_s,differential_head_m\n0,0\n");
  write_rows(statistics, 0.1, 2);
  EXPECT_EQ(read("statistics.csv"), "time_s,differential_head_m\n0,0\n0.1,1\n0.2,2\n");
}

TEST_F(StatisticsTest, LeavesEmptyWhatWasNotSet)
{
  auto statistics = make();
  write_rows(statistics, 1., 1);
  statistics.set("time_s", 2.);
  statistics.write_row();
  statistics.set("time_s", -0.);
  statistics.write_row();
  EXPECT_EQ(read("statistics.csv"), "time_s,differential_head_m\n1,10\n2,\n0,\n");
}

TEST_F(StatisticsTest, KeepsThePrecision)
{
  auto statistics = make(4);
  statistics.set("time_s", 1. / 3.);
  statistics.set("differential_head_m", 1.23456789e-12);
  statistics.write_row();
  EXPECT_EQ(read("statistics.csv"), "time_s,differential_head_m\n0.3333,1.235e-12\n");
}

TEST_F(StatisticsTest, ResumesAfterTheGivenTime)
{
  {
    auto statistics = make(4);
    write_rows(statistics, 1. / 3., 5); // 0.3333 0.4333 0.5333 0.6333 0.7333
  }
  std::ofstream(path("statistics.csv"), std::ios::app) << "0.83"; // torn
  auto statistics = make(4);
  statistics.resume(1. / 3. + 0.2);
  write_rows(statistics, 0.6, 1);
  EXPECT_EQ(read("statistics.csv"), "time_s,differential_head_m\n0.3333,3.333\n0.4333,4.333\n0.5333,5.333\n0.6,6\n");
  EXPECT_EQ(n_files(), 1u);
}

TEST_F(StatisticsTest, DropsATornLastLine)
{
  write("statistics.csv", "time_s,differential_head_m\n0,0\n0.1,1");
  auto statistics = make();
  statistics.resume(1.);
  write_rows(statistics, 2., 1);
  EXPECT_EQ(read("statistics.csv"), "time_s,differential_head_m\n0,0\n2,20\n");
}

TEST_F(StatisticsTest, ColumnsComeAndGo)
{
  write("statistics.csv", "time_s,flux_m_s\n0,5\n1,6\n2,7\n3");
  auto statistics = make();
  statistics.resume(1.);
  write_rows(statistics, 1.5, 1);
  EXPECT_EQ(read("statistics.csv"), "time_s,flux_m_s,differential_head_m\n0,5,\n1,6,\n1.5,,15\n");
}

TEST_F(StatisticsTest, DoesNotResumeWhatIsNoneOfItsFiles)
{
  write("statistics.csv", "name,flux_m_s\n0,0\n");
  auto statistics = make();
  EXPECT_NE(complaint<UserError>([&] { statistics.resume(1.); }).find("does not begin with the column 'time_s'"),
            std::string::npos);
  EXPECT_EQ(read("statistics.csv"), "name,flux_m_s\n0,0\n");
  Statistics missing(path("missing.csv"), MPI_COMM_SELF);
  missing.add_column("time_s");
  EXPECT_NE(complaint<UserError>([&] { missing.resume(1.); }).find("cannot read"), std::string::npos);
}

TEST_F(StatisticsTest, Mistakes)
{
  Statistics nowhere(path("no/folder.csv"), MPI_COMM_SELF);
  nowhere.add_column("time_s");
  EXPECT_NE(complaint<UserError>([&] { nowhere.write_row(); }).find("No such file"), std::string::npos);

  auto statistics = make();
  EXPECT_THROW(statistics.set("other", 1.), dealii::ExceptionBase);
  EXPECT_THROW(statistics.add_column("time_s"), dealii::ExceptionBase);
  EXPECT_THROW(statistics.add_column("a,b"), dealii::ExceptionBase);
  write_rows(statistics, 0., 1);
  EXPECT_THROW(statistics.add_column("late_s"), dealii::ExceptionBase);
}

TEST(Statistics, NamesInColumnsAreDistinct)
{
  using alluvium::output::names_in_columns;
  const auto names = names_in_columns({"a b", "a_b", "a,b", "a_b_2", "c", "c"}, " ");
  EXPECT_EQ(names.at("a b"), "a_b");
  EXPECT_EQ(names.at("a_b"), "a_b_2");
  EXPECT_EQ(names.at("a,b"), "a_b_3");
  EXPECT_EQ(names.at("a_b_2"), "a_b_2_2");
  EXPECT_EQ(names.at("c"), "c");
  EXPECT_EQ(names.size(), 5u);
  EXPECT_EQ(names_in_columns({"a b", "a\"b"}).at("a\"b"), "a_b");
}
