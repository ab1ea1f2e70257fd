#pragma once

#include <mpi.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace dealii
{
  class ParameterHandler;
}

namespace alluvium
{
  /**
   * A whole run: fluid, grains and what couples them, in the order that step() shows. Life cycle: construct,
   * add_parameters(), let the parameter handler parse, then check() or run().
   */
  class Simulation
  {
  public:
    explicit Simulation(MPI_Comm communicator);
    ~Simulation();

    /** What `Method = paper` changes: (parameter, value). */
    static std::vector<std::pair<std::string, std::string>> paper_method();

    /** Declare every parameter of the program in @p prm and bind it to the object that uses it. */
    void add_parameters(dealii::ParameterHandler &prm);

    /** What `Accuracy` has chosen and why, in @p lines for the scene's report. */
    void describe_accuracy(const std::vector<std::string> &lines);

    /**
     * Build the scene, report what it is and what it leaves out, and stop; throws what run() would before its first
     * step, and writes no files. That the output folder holds an older run is only a warning.
     */
    void check(const dealii::ParameterHandler &prm, const std::string &parameter_directory);

    /**
     * Run to the end time, or until a SIGINT or SIGTERM ends it after a step with outputs closed and a checkpoint
     * written.
     * @p prm is written to the output folder as used.
     */
    void run(const dealii::ParameterHandler &prm, const std::string &parameter_directory);

  private:
    class Implementation;
    std::unique_ptr<Implementation> implementation;
  };
} // namespace alluvium
