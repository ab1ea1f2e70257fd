#include <alluvium/utilities/divergence.h>
#include <alluvium/utilities/failure.h>
#include <alluvium/utilities/user_error.h>

#include <deal.II/base/exceptions.h>

#include <gtest/gtest.h>

using namespace alluvium;

namespace
{
  template <typename Exception>
  Failure of(const Exception &exception)
  {
    return describe_failure(std::make_exception_ptr(exception));
  }
} // namespace

TEST(Failure, ExitCodes)
{
  EXPECT_EQ(of(UserError("a")).exit_code, 1);
  EXPECT_EQ(of(UserError("a")).message, "a");
  EXPECT_EQ(of(std::runtime_error("b")).exit_code, 2);
  EXPECT_EQ(of(Divergence("c")).exit_code, 3);
  EXPECT_EQ(of(Divergence("c")).message, "c");
  EXPECT_EQ(of(42).exit_code, 2);
  const Failure library = of(dealii::ExcMessage("d"));
  EXPECT_EQ(library.exit_code, 2);
  EXPECT_EQ(library.message.rfind("d", 0), 0u) << library.message;
}

TEST(Failure, Together)
{
  MPI_Comm communicator;
  MPI_Comm_dup(MPI_COMM_SELF, &communicator);
  EXPECT_TRUE(failed_together(communicator, "the same"));
  MPI_Comm_free(&communicator);
}
