#pragma once

#include <alluvium/observers/observer.h>
#include <alluvium/output/field_series.h>
#include <alluvium/output/output_folder.h>
#include <alluvium/utilities/timers.h>

#include <nlohmann/json_fwd.hpp>

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace alluvium::run
{
  struct Model;

  /** How a run has ended. */
  struct Ending
  {
    std::string how;           // finished, interrupted or failed
    std::string reason;        // in words
    int         exit_code = 0; // of the program
  };

  /** All that a run measures and writes: observers, statistics.csv, summary.json and pictures. */
  class Output
  {
  public:
    explicit Output(Model &model);

    void add_parameters(dealii::ParameterHandler &prm);

    /** After the file was read; see Plugin. Throws UserError. */
    void parse_parameters();

    /** Choose the observers that find something to measure in the scene. After set_up(). */
    void choose_observers();

    /** Where the differential head is taken: one line. */
    std::string where_head() const;

    /** Which observers work, and which were left out: one line. */
    std::string observers() const;

    const output::OutputFolder &folder() const { return output_folder; }

    /** Between two outputs of each kind [s]; 0: in every step, or never. */
    std::vector<double> intervals() const { return {row_interval, picture_interval}; }

    /** As OutputFolder::check(). Collective. */
    std::string check_folder(bool is_restart, bool may_hold_a_run);

    /** Does the summary in the folder tell of a run that has come to its end? */
    bool holds_finished_run() const;

    /** Make the folder that the run writes to, or with @p is_restart check that it is there. Collective. */
    void make_folder(bool is_restart);

    /** Get ready to write to it. After choose_observers(). */
    void open();

    /** The state of t = 0. */
    void write_beginning();

    /** After each step: measure it, and write what is due. */
    void update();

    /** Write summary.json and print warnings and the table of times. Collective. */
    void conclude(const Ending &ending);

    /** Write summary.json with what this rank knows: the others are lost, or the run goes on. No communication. */
    void write_summary_alone(const Ending &ending);

    /** Put @p text under @p path, whenever the summary is written from now on. */
    void add_to_summary(const std::string &path, const std::string &text) { extra_texts[path] = text; }
    void add_to_summary(const std::string &path, const double number) { extra_numbers[path] = number; }

    /** For checkpoints: what a restarted run must remember. */
    void save(nlohmann::ordered_json &state) const;
    void load(const nlohmann::ordered_json &state);

  private:
    observers::Snapshot snapshot() const;
    void                choose_head();
    double              head() const;
    void                observe();
    void                write_row();
    void                write_pictures();
    void                fill_summary(const Ending &ending, const std::map<std::string, Timers::Phase> &phases);
    void                warn_of_drag_range();

    Model                            &model;
    output::OutputFolder              output_folder;
    PluginChoice<observers::Observer> choice;
    double                            picture_interval = 0.05, row_interval = 0.01; // [s]
    std::string                       format    = "vtu", head_between;
    unsigned int                      precision = 10;

    std::vector<observers::Observer *>      observing;
    std::unique_ptr<observers::FluidView>   fluid_view;
    std::vector<dealii::types::boundary_id> head_ids; // of two boundaries, if the head is between them
    std::unique_ptr<output::Statistics>     statistics;
    std::unique_ptr<output::Summary>        summary;
    std::unique_ptr<output::FieldSeries>    fluid_pictures, grain_pictures, wall_pictures;

    bool has_pictures = false; // of the latest step

    // impulses of the fluid on all grains, and on those outside the range of the drag law [N s/m]
    double drag_impulse = 0., drag_impulse_outside = 0.;

    std::map<std::string, std::string> extra_texts;
    std::map<std::string, double>      extra_numbers;
  };

  /** Whether a multiple of @p interval lies in (time - dt, time]; an interval of 0 is due always. */
  bool is_due(double time, double dt, double interval);
} // namespace alluvium::run
