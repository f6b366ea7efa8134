// bench film: a scene as pictures, a film, or files for other programs.
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <stdexcept>

#include "harness/base/errors.h"
#include "harness/base/files.h"
#include "harness/base/interrupt.h"
#include "harness/base/paths.h"
#include "harness/base/pattern.h"
#include "harness/base/statistics.h"
#include "harness/base/text.h"
#include "harness/cli/exit_codes.h"
#include "harness/cli/figures.h"
#include "harness/cli/shared_options.h"
#include "harness/cli/verbs.h"
#include "harness/film/exports.h"
#include "harness/film/pictures.h"
#include "harness/points/suite.h"
#include "harness/points/tuned.h"

namespace harness {
namespace {

struct FilmOptions : SceneOptions {
  std::string solver = "fast_projection", limits = "0.01", out, stills;
  double step = 0;  // s; 0: not given
  double frames_per_second = 30;
  int width = 0;  // pixels; 0: not given
};

constexpr int default_width = 480;
// Rays a pixel, each way: a still can take its time, a film has hundreds of pictures.
constexpr int still_samples = 6, film_samples = 3;

FilmSpec film_spec(const FilmOptions& given) {
  FilmSpec spec;
  spec.scene = scene_of(given);
  spec.parameters = complete_parameters_of(given);
  check_solver_pattern(given.solver);
  const Pattern wanted("--solver", given.solver);
  for (const auto& backend : inextensible::backends()) {
    if (wanted.matches(backend.name)) spec.solvers.push_back({backend.name, backend.name});
  }
  tune(spec.solvers, read_tuned_up_to_date("tuned.json"), find_scene(spec.scene)->kind(), {},
       false);
  spec.strain_limits = numbers_of("--limit", given.limits, Bounds::strain());
  if (given.step > 0) spec.step = given.step;
  spec.frames_per_second = given.frames_per_second;
  return spec;
}

void tell(const FilmRun& take, std::size_t frame, std::size_t frames) {
  if (isatty(STDERR_FILENO) != 1 && frame < frames) return;
  std::cerr << (isatty(STDERR_FILENO) == 1 ? "\r\033[K" : "") << take.label << " at "
            << number_text(100 * take.strain_limit) << " %, steps of 1/"
            << number_text(1 / take.step, 6) << " s: frame " << frame << " of " << frames
            << (frame == frames || isatty(STDERR_FILENO) != 1 ? "\n" : "");
}

// How long a frame took: what an engine asks for.
void print_times(const Recording& recording) {
  std::cout << "milliseconds a frame:\n";
  for (const FilmRun& take : recording.takes) {
    std::cout << "  " << take.solver << ", " << number_text(100 * take.strain_limit)
              << " %, steps of 1/" << number_text(1 / take.step, 6) << " s: ";
    if (!take.seconds.empty()) {
      const auto at = [&take](double part) {
        return number_text(1e3 * quantile(take.seconds, part), 3);
      };
      std::cout << "median " << at(0.5) << ", 99 of 100 below " << at(0.99) << ", worst " << at(1)
                << "; largest strain "
                << number_text(100 * *std::max_element(take.largest_strain.begin(),
                                                       take.largest_strain.end()),
                               3)
                << " %";
    }
    if (take.smallest_step < take.step)
      std::cout << "; steps down to 1/" << number_text(1 / take.smallest_step, 6) << " s";
    if (!take.energy_gained.empty()) std::cout << "; gains energy: " << take.energy_gained;
    std::cout << (take.detail.empty() ? "" : "; " + take.detail) << '\n';
  }
}

// Which frames are drawn: all of a film; of stills those nearest to the times given, or four.
std::vector<std::size_t> shown_frames(const FilmOptions& given, const FilmSpec& spec, bool still) {
  const std::size_t last = frames_in(spec) - 1;
  std::vector<std::size_t> frames;
  if (!still) {
    for (std::size_t i = 0; i <= last; ++i) frames.push_back(i);
    return frames;
  }
  if (given.stills.empty()) return {0, last / 3, 2 * last / 3, last};
  const double end = static_cast<double>(last) / spec.frames_per_second;
  for (const double time : numbers_of("--stills", given.stills, Bounds::at_least(0))) {
    if (time > end + 0.5 / spec.frames_per_second)
      throw UsageError("--stills: " + number_text(time) + " s is not within the film, 0 to " +
                       number_text(end) + " s (--set duration=SECONDS changes that)");
    frames.push_back(static_cast<std::size_t>(std::lround(time * spec.frames_per_second)));
  }
  return frames;
}

void tell_picture(std::size_t done, std::size_t all) {
  if (isatty(STDERR_FILENO) == 1)
    std::cerr << "\r\033[K" << done << " of " << all << " pictures" << (done == all ? "\n" : "");
}

// Pictures go to the script that puts them together in a folder of their own.
int draw_pictures(const FilmOptions& given, const Recording& recording, bool still) {
  const TemporaryFolder folder("film");
  PictureSpec spec;
  spec.frames = shown_frames(given, recording.spec, still);
  spec.width = given.width > 0 ? given.width : default_width;
  spec.samples = still ? still_samples : film_samples;
  write_film_header(folder.path(), recording);
  write_pictures(folder.path(), recording, spec, interrupted, tell_picture);
  const std::filesystem::path out(given.out);
  return draw("film.py", {folder.path()}, out.parent_path().string(), out.filename().string());
}

using Writer = std::vector<std::string> (*)(const Recording&, const FilmRun&, const std::string&,
                                            const std::string&);

// Writer of a file for other programs; null: pictures.
Writer writer_of(const FilmOptions& given, const std::string& extension) {
  const std::vector<std::pair<std::string, Writer>> writers{
      {".obj", write_obj}, {".pvd", write_vtk}, {".pc2", write_pc2}};
  const auto writer = std::find_if(writers.begin(), writers.end(),
                                   [&](const auto& w) { return w.first == extension; });
  const bool pictures = extension == ".png" || extension == ".webp" || extension == ".mp4";
  if (writer == writers.end() && !pictures)
    throw UsageError("--out '" + given.out +
                     "': must end in .webp, .mp4, .png (stills), .obj, .pvd (ParaView) or .pc2 "
                     "(Blender)");
  if (!given.stills.empty() && extension != ".png")
    throw UsageError("--stills: --out '" + given.out + "' must end in .png");
  if (given.width > 0 && !pictures)
    throw UsageError("--width: '" + given.out + "' has no pictures");
  return writer == writers.end() ? nullptr : writer->second;
}

// results/local/film-drape.webp, or .png where stills are asked for; numbered where that is there.
std::string default_output(const FilmOptions& given) {
  const std::string scene = given.scene.substr(0, given.scene.find(':'));
  const auto numbered = [&](int i) {
    return local_result("film-" + scene + (i == 1 ? "" : "-" + std::to_string(i)) +
                        (given.stills.empty() ? ".webp" : ".png"));
  };
  int free = 1;
  while (std::filesystem::exists(numbered(free))) ++free;
  return numbered(free);
}

// A scene of impossible measures, or a method that cannot run it, is the user's mistake.
Recording recorded(const FilmSpec& spec) {
  try {
    return record(spec, interrupted, tell);
  } catch (const std::invalid_argument& error) {
    throw UsageError(error.what());
  }
}

int film(FilmOptions given) {
  const FilmSpec spec = film_spec(given);
  if (given.out.empty()) given.out = default_output(given);
  const std::string extension = std::filesystem::path(given.out).extension().string();
  const Writer writer = writer_of(given, extension);
  (void)shown_frames(given, spec, extension == ".png");  // refused before anything runs
  check_writable(given.out);
  catch_interrupts();
  const Recording recording = recorded(spec);
  print_times(recording);
  if (!writer) return draw_pictures(given, recording, extension == ".png");
  const std::filesystem::path out(given.out);
  const std::string folder = out.has_parent_path() ? out.parent_path().string() : ".";
  for (const FilmRun& take : recording.takes) {
    const bool one = recording.takes.size() == 1;
    const std::string name =
        out.stem().string() + (one ? "" : "-" + take.solver + "-" + number_text(take.strain_limit));
    for (const std::string& path : writer(recording, take, folder, name)) std::cout << path << '\n';
  }
  return success;
}

}  // namespace

Verb film_verb() {
  return {
      "film", "render a scene as stills or a film, or export it for ParaView and Blender",
      [](const Command& command) -> Action {
        const auto given = std::make_shared<FilmOptions>();
        given->scene = "drape";
        add_scene(command, *given, given->scene);
        add_solver(command, given->solver);
        add_limits(command, given->limits, given->limits);
        command
            .option("--step", given->step,
                    "s; shortened to a whole part of a frame; default: 0.01, or as short as the "
                    "energy check asks for",
                    "S")
            .positive();
        command.option("--fps", given->frames_per_second, "frames a second", "N").positive();
        command.option("--stills", given->stills,
                       "times of the pictures in a .png, s, between commas; default: four",
                       "TIMES");
        command.option("--width", given->width, "of each picture; default: 480", "PIXELS")
            .within(16, 4096);
        command.option("--out", given->out,
                       ".webp or .mp4: a film; .png: stills; .obj, .pvd, .pc2: for other programs; "
                       "default: results/local/film-<scene>.webp, .png with --stills",
                       "FILE");
        return [given] { return film(*given); };
      }};
}

}  // namespace harness
