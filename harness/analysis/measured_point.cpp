#include "harness/analysis/measured_point.h"

#include <iomanip>

#include "harness/points/point_json.h"

namespace harness::analysis {

Point::Point(const json& document, double noise, double scatter)
    : result_(std::make_shared<PointResult>(point_of(document))),
      id_(document.at("id")),
      noise_(noise),
      scatter_(scatter) {}

double Point::scene_parameter(const char* name) const {
  const auto place = spec().scene_parameters.find(name);
  return place == spec().scene_parameters.end() ? std::nan("") : place->second;
}

double Point::stiffness() const {
  if (result_->stiffness) return *result_->stiffness;
  const auto given = spec().settings.find("stiffness");
  return given == spec().settings.end() ? std::nan("") : std::get<double>(given->second);
}

double Point::delivered_strain() const {
  const double after = measures().max_strain_after_collision;
  return std::isfinite(after) ? after : measures().max_strain;
}

ErrorAtLevel Point::error_at(double level) const {
  return harness::error_at(measures(), level == any_motion ? headline_error : level);
}

namespace {

// By occasion, of those that both have.
std::map<int, double> ratios_of_occasions(const Point& a, const Point& b) {
  const auto others = b.result().times();
  std::map<int, double> ratios;
  for (const auto& [occasion, seconds] : a.result().times())
    if (const auto other = others.find(occasion); other != others.end())
      ratios[occasion] = seconds / other->second;
  return ratios;
}

// The values but that of one occasion; -1: all.
std::vector<double> values_without(const std::map<int, double>& by_occasion, int without) {
  std::vector<double> values;
  for (const auto& [occasion, value] : by_occasion)
    if (occasion != without) values.push_back(value);
  return values;
}

}  // namespace

Ratio ratio(const Point& a, const Point& b) {
  const double noise = std::fmax(a.noise(), b.noise());
  const auto ratios = values_without(ratios_of_occasions(a, b), -1);
  const double scatter = std::fmax(a.scatter(), b.scatter());
  return ratios.size() > 1 && std::isfinite(scatter)
             ? ratio_on_another_day(ratios, scatter, noise)
             : ratio_of_times(a.result().samples, b.result().samples, noise);
}

Coverage coverage_of(const Runs& runs) {
  const auto place_of = [](const Point& p) {
    return std::tuple(p.scene(), p.sweep(), p.spec().scene_parameters, p.strain_limit());
  };
  std::vector<Point> best;
  std::ranges::copy_if(runs.points, std::back_inserter(best),
                       [](const Point& p) { return p.result().best_somewhere(); });
  Coverage found;
  for (const Point& p : best)
    found.occasions = std::max(found.occasions, static_cast<int>(p.result().times().size()));
  for (int day = 0; found.occasions > 2 && day < found.occasions; ++day) {
    std::vector<std::vector<double>> times;
    times.reserve(best.size());
    for (const Point& p : best) times.push_back(values_without(p.result().times(), day));
    const double scatter = scatter_of(times);
    for (const auto& [place, here] : grouped(best, place_of))
      for (std::size_t i = 0; i < here.size(); ++i)
        for (std::size_t j = i + 1; j < here.size(); ++j) {
          const auto ratios = ratios_of_occasions(here[i], here[j]);
          const auto then = ratios.find(day);
          if (then == ratios.end() || ratios.size() < 3) continue;
          const Ratio ratio =
              ratio_on_another_day(values_without(ratios, day), scatter, here[i].noise());
          ++found.ratios;
          found.outside += then->second < ratio.low || then->second > ratio.high;
        }
  }
  return found;
}

std::string text(const Coverage& coverage) {
  if (coverage.occasions < 2) return "";
  std::string words = concat("The best runs were timed on ", coverage.occasions, " occasions");
  if (coverage.ratios > 0)
    words += concat("; of ", coverage.ratios, " ratios of two times on one of them, ",
                    percent(static_cast<double>(coverage.outside) / coverage.ratios),
                    " lay outside the interval that the others give (5 % are to be expected)");
  return words + ".";
}

ContestantRoles::ContestantRoles(const json& document) {
  const json legend = document.value("legend", json::object());
  for (const json& entry : legend.value("solvers", json::array())) {
    const std::string name = entry.at("name");
    known.try_emplace(name, Role{.name = name,
                                 .family = entry.value("family", name),
                                 .solver = entry.value("solver", name),
                                 .competes = entry.value("contestant", true),
                                 .unranked = entry.value("unranked", false)});
  }
  const json pair = document.value(json::json_pointer("/context/noise/pair"), json());
  if (pair.is_array()) {
    const std::string second = pair.at(1);
    known.try_emplace(second, Role{second, second, second}).first->second.again = true;
  }
}

Role ContestantRoles::of(const std::string& contestant) const {
  const auto place = known.find(contestant);
  return place != known.end() ? place->second : Role{contestant, contestant, contestant};
}

Runs::Runs(const json& document) : roles(document), levels{any_motion} {
  const json q95 = document.value(json::json_pointer("/context/noise/q95"), json());
  const double noise = q95.is_number() ? q95.get<double>() : std::nan("");
  const json between = document.value(json::json_pointer("/context/scatter"), json());
  const double scatter = between.is_number() ? between.get<double>() : std::nan("");
  // Where results were joined, each point has its own file's.
  for (const json& p : document.at("points"))
    points.emplace_back(p, p.value("noise", noise), p.value("scatter", scatter));
  const double finest =
      document.value(json::json_pointer("/context/suite/finest_error"), answer_levels.back());
  for (const double level : answer_levels)
    if (level >= finest) levels.push_back(level);
}

std::string scene_words(const std::string& scene) {
  const std::size_t begin = scene.find(':') + 1;  // of "mesh:" or "folder:"
  if (begin == 0) return scene;
  const std::string file = scene.substr(begin, scene.find(',') - begin);
  const std::size_t content = scene.find("content=");
  return file.substr(file.find_last_of('/') + 1) +
         (content == std::string::npos ? "" : " (" + scene.substr(content + 8, 4) + ")");
}

std::string percent(double fraction) { return number_text(100 * fraction, 3) + " %"; }

std::string time_words(double seconds) {
  return seconds >= 1 ? number_text(seconds, 3) + " s" : number_text(1e3 * seconds, 3) + " ms";
}

std::string text(const Ratio& ratio) {
  if (std::isnan(ratio.value)) return "?";
  if (!ratio.known() || !(ratio.value > 0))
    return number_text(ratio.value, ratio.value >= 100 ? 3 : 2) + " (?)";
  // Decimals that show the interval's width and two digits of each number; at most four digits.
  const auto order = [](double x) { return static_cast<int>(std::floor(std::log10(x))); };
  const int most = std::max(0, 3 - order(ratio.value));
  const int width = ratio.high > ratio.low ? -order(ratio.high - ratio.low) : most;
  const int wanted = std::max(width, 1 - order(ratio.low));
  const auto fixed = [decimals = std::clamp(wanted, 0, most)](double x) {
    std::ostringstream out;
    out << std::fixed << std::setprecision(decimals) << x;
    return out.str();
  };
  return fixed(ratio.value) + " (" + fixed(ratio.low) + "-" + fixed(ratio.high) + ")";
}

}  // namespace harness::analysis
