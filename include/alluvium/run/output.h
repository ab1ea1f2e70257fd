#pragma once

#include <alluvium/observers/field_series.h>
#include <alluvium/observers/observer.h>
#include <alluvium/observers/output_folder.h>

#include <nlohmann/json_fwd.hpp>

#include <iosfwd>
#include <memory>
#include <string>
#include <vector>

namespace alluvium::run
{
  struct Model;

  /** All that a run measures and writes: observers, statistics.csv, summary.json and pictures. */
  class Output
  {
  public:
    explicit Output(Model &model);

    void add_parameters(dealii::ParameterHandler &prm);

    /** Choose the observers that find something to measure in the scene. After set_up(). */
    void choose_observers();

    /** Which observers work, and which were left out: one line. */
    std::string observers() const;

    const observers::OutputFolder &folder() const { return output_folder; }

    /** Make the folder that the run writes to, or with @p is_restart check that it is there. Collective. */
    void make_folder(bool is_restart);

    /** Get ready to write to it. After choose_observers(). */
    void open();

    /** The state of t = 0. */
    void write_beginning();

    /** After each step: measure it, and write what is due. */
    void update();

    /** summary.json and the table of times; @p interrupted: by a signal. */
    void conclude(bool interrupted);

    /** For checkpoints: what a restarted run must remember. */
    void save(nlohmann::ordered_json &state) const;
    void load(const nlohmann::ordered_json &state);

  private:
    observers::Snapshot snapshot() const;
    double              head() const;
    void                observe();
    void                write_row();
    void                write_pictures();
    void                warn_of_drag_range();

    Model                            &model;
    observers::OutputFolder           output_folder;
    PluginChoice<observers::Observer> choice;
    double                            picture_interval = 0.05, row_interval = 0.01; // [s]
    std::string                       format    = "vtu";
    unsigned int                      precision = 10;

    std::vector<observers::Observer *>      observing;
    std::unique_ptr<observers::FluidView>   fluid_view;
    std::unique_ptr<observers::Statistics>  statistics;
    std::unique_ptr<observers::Summary>     summary;
    std::unique_ptr<observers::FieldSeries> fluid_pictures, grain_pictures;
  };

  /** Whether a multiple of @p interval lies in (time - dt, time]; an interval of 0 is due always. */
  bool is_due(double time, double dt, double interval);
} // namespace alluvium::run
