#pragma once

namespace dealii
{
  class ParameterHandler;
}

namespace alluvium
{
  /**
   * Base of all interfaces of plug-ins. Parameters go the same way in plug-ins and in all other classes:
   *
   * 1. add_parameters() declares them where they are used, and binds them to members;
   * 2. parse_parameters(), after the file was read, makes of texts what they mean and refuses what no pattern can;
   * 3. `initialize()`, or `check()` where nothing is made, looks at them with the scene, each with what it needs of it.
   *
   * The last two throw UserError. What one of them can refuse, no later function should.
   */
  class Plugin
  {
  public:
    virtual ~Plugin() = default;

    /** Declare the parameters in the current section. May be called with several handlers. */
    virtual void add_parameters(dealii::ParameterHandler &) {}

    /** Of plug-ins that are used, and of those that they use; the same on all ranks. */
    virtual void parse_parameters() {}
  };
} // namespace alluvium
