// bench film: a scene as pictures, a film, or files for other programs.
#include <numeric>

#include "harness/analysis/measured_point.h"
#include "harness/cli/command.h"
#include "harness/film/film.h"
#include "harness/points/tuned.h"

namespace harness {
namespace {

constexpr int default_width = 480;

using analysis::percent;

std::string name_of(const FilmRun& run, const std::string& solver) {
  return solver + ", " + percent(run.strain_limit) + ", steps of " + step_text(run.step) + " s";
}

void print_times(const Recording& recording) {
  std::cout << "milliseconds a frame:\n";
  for (const FilmRun& run : recording.takes) {
    std::cout << "  " << name_of(run, run.solver) << ": ";
    if (!run.seconds.empty()) {
      const auto at = [&run](double part) {
        return number_text(1e3 * quantile(run.seconds, part), 3);
      };
      std::cout << "median " << at(0.5) << ", 99 of 100 below " << at(0.99) << ", worst " << at(1)
                << "; largest strain " << percent(*std::ranges::max_element(run.largest_strain));
    }
    if (run.smallest_step < run.step)
      std::cout << "; steps down to " << step_text(run.smallest_step) << " s";
    if (!run.energy_gained.empty()) std::cout << "; gains energy: " << run.energy_gained;
    std::cout << (run.detail.empty() ? "" : "; " + run.detail) << '\n';
  }
}

struct Film : SceneOptions {
  std::string solver = "fast_projection", out;
  FilmSpec film;
  Numbers stills;
  int width = 0;  // pixels; 0: not given

  void declare(const Command& command) {
    scene = "drape";
    SceneOptions::declare(command, scene);
    add_solver(command, solver);
    add_limits(command, film.strain_limits, "0.01");
    command.option("--step", film.step, "s; shortened to a whole part of a frame; default: 0.01",
                   "S", Bounds::positive());
    command.option("--fps", film.frames_per_second, "frames a second", "N", Bounds::positive());
    command.option("--stills", stills,
                   "times of the pictures in a .png, s, between commas; default: four", "TIME",
                   {.least = 0});
    command.option("--width", width, "of each picture; default: 480", "PIXELS",
                   {.least = 16, .most = 4096, .whole = true});
    command.option("--out", out,
                   ".webp: a film; .png: stills; .obj: for other programs; default: "
                   "results/local/film-<scene>.webp, .png with --stills",
                   "FILE");
  }

  // The frames drawn: all for a film; for stills those nearest to the given times, or four.
  std::vector<std::size_t> shown_frames(bool still) const {
    const std::size_t last = frames_in(film) - 1;
    std::vector<std::size_t> frames(last + 1);
    std::iota(frames.begin(), frames.end(), std::size_t{0});
    if (!still) return frames;
    if (stills.empty()) return {0, last / 3, 2 * last / 3, last};
    frames.clear();
    const double end = static_cast<double>(last) / film.frames_per_second;
    for (const double time : stills) {
      if (time > end + 0.5 / film.frames_per_second)
        throw UsageError(concat("--stills: ", time, " s is not within the film, 0 to ", end,
                                " s (--set duration=SECONDS changes that)"));
      frames.push_back(static_cast<std::size_t>(std::lround(time * film.frames_per_second)));
    }
    return frames;
  }

  // Impossible scene parameters, or a method that cannot run the scene, are the user's mistake.
  Recording recorded() const {
    Progress progress;
    try {
      return record(film, [&](const FilmRun& run) {
        if (run.frames.size() == 1) progress.begin_part();
        progress.show(run.frames.size(), frames_in(film), name_of(run, run.label));
      });
    } catch (const std::invalid_argument& error) {
      throw UsageError(error.what());
    }
  }

  int run() {
    film.scene = name();
    film.parameters = complete_parameters();
    (void)solver_pattern(solver);                           // refuses what is no solver
    for (const std::string& part : alternatives(solver)) {  // in the order given
      const Pattern wanted("--solver", part);
      for (const auto& backend : backends())
        if (wanted.matches(backend.name) &&
            find_contestant(film.solvers, backend.name) == film.solvers.end())
          film.solvers.push_back({backend.name, backend.name});
    }
    tune(film.solvers, read_tuned_up_to_date("tuned.json"), find_scene(film.scene)->kind());
    if (out.empty())
      out = default_output("film-" + scene.substr(0, scene.find(':')),
                           stills.empty() ? ".webp" : ".png");
    const std::filesystem::path place(out);
    const std::string ending = place.extension().string();
    if (ending != ".webp" && ending != ".png" && ending != ".obj")
      throw UsageError("--out '" + out + "': must end in .webp, .png (stills) or .obj");
    if (!stills.empty() && ending != ".png")
      throw UsageError("--stills: --out '" + out + "' must end in .png");
    if (width > 0 && ending == ".obj") throw UsageError("--width: '" + out + "' has no pictures");
    const bool still = ending == ".png";
    const auto frames = shown_frames(still);  // before anything runs
    check_writable(out);
    if (ending != ".obj") check_povray();
    const Recording recording = recorded();
    print_times(recording);
    if (ending != ".obj") {
      const TemporaryFolder pictures("film");
      Progress progress;
      write_pictures(
          pictures.path(), recording, {frames, width > 0 ? width : default_width, still},
          [&progress](std::size_t done, std::size_t all) { progress.show(done, all, "pictures"); });
      progress.clear();
      return draw("film.py", {pictures.path()}, out);
    }
    const std::string folder = place.has_parent_path() ? place.parent_path().string() : ".";
    for (const FilmRun& run : recording.takes) {
      const std::string own_part =
          recording.takes.size() == 1 ? "" : "-" + run.solver + "-" + number_text(run.strain_limit);
      for (const std::string& path :
           write_meshes(recording, run, folder, place.stem().string() + own_part))
        std::cout << path << '\n';
    }
    return success;
  }
};

}  // namespace

Action film_verb(const Command& command) { return verb<Film>(command); }

}  // namespace harness
