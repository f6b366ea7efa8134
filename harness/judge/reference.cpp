#include "harness/judge/reference.h"

#include <algorithm>

#include "harness/base/files.h"

namespace harness {
namespace {

constexpr const char* reference_schema = "inextensible-reference/2";

constexpr auto reference_fields = std::tuple{
    field("scene", &Reference::scene, "", "its name"),
    field("scene_parameters", &Reference::parameters, "", "all of the scene's"),
    field("method", &Reference::method, "", "first route"),
    field("second_method", &Reference::second_method, "", "second route"),
    field("times", &Reference::times, "s", "of samples"),
    field("gap", &Reference::gap, "size", "uncertainty at each time"),
    field("gap_max", &Reference::gap_max, "size", "the same in the maximum norm"),
    field("gap_parts", &Reference::gap_parts, "size", "whose largest is the gap", may_be_absent),
    field("valid_until", &Reference::valid_until, "s", "last time of a gap below 1 %"),
    field("energy_drift", &Reference::energy_drift, "weight times size", "of the first route"),
    field("observed_order", &Reference::observed_order, "", "under step halving", may_be_absent)};

// Why a reference fits no scene of this program; "": it fits one.
std::string mismatch(const Reference& r) {
  const auto type = find_scene(r.scene);
  if (!type) return "no scene '" + shortened(r.scene, 40) + "'";
  if (complete_parameters(*type, r.parameters) != r.parameters)
    return "'scene_parameters' must hold every parameter of the scene";
  const int vertices = type->counts(r.parameters).first;
  for (const Positions& x : r.positions)
    if (x.cols() != vertices)
      return concat("positions of ", x.cols(), " vertices, the scene has ", vertices);
  const std::size_t times = r.times.size();
  const bool agree =
      r.gap.size() == times && r.gap_max.size() == times && r.positions.size() <= times;
  return agree ? "" : "lists of different lengths";
}

json summary_of(const Reference& r) {
  double squares = 0;
  for (std::size_t i = 0; i < r.positions.size(); ++i) squares += r.gap[i] * r.gap[i];
  const auto valid = static_cast<double>(std::max<std::size_t>(r.positions.size(), 1));
  return {{"name", r.name()},
          {"method", r.method},
          {"second_method", r.second_method},
          {"valid_until", r.valid_until},
          {"gap", std::sqrt(squares / valid)},
          {"observed_order", number(r.observed_order)},
          {"energy_drift", r.energy_drift}};
}

// The motion of a scene that is known exactly, at the sample times. Null for other scenes.
std::shared_ptr<const Reference> exact_reference(const std::string& scene_name,
                                                 const SceneParameters& complete) {
  const auto type = find_scene(scene_name);
  if (!type->exact) return nullptr;
  const auto r = std::make_shared<Reference>();
  r->scene = scene_name;
  r->parameters = complete;
  r->method = r->second_method = "exact";
  r->exact = true;
  r->times = sample_times(complete.at("duration"));
  for (const double time : r->times) r->positions.push_back(type->exact(complete, time));
  r->gap.assign(r->times.size(), 0);
  r->gap_max = r->gap;
  r->valid_until = r->duration();
  return r;
}

// The reference that a scene's files name. Null where the scene lasts otherwise than there.
std::shared_ptr<const Reference> reference_from_files(const std::string& scene,
                                                      const SceneParameters& complete) {
  const auto type = find_scene(scene);
  if (type->reference.empty()) return nullptr;
  const NumberArrays arrays = read_npz(type->reference);
  for (const char* name : {"times", "positions", "gap", "gap_max"})
    if (!arrays.contains(name))
      throw UsageError("'" + type->reference + "' has no array '" + name + "'");
  auto r = std::make_shared<Reference>();
  r->scene = scene;
  r->parameters = complete;
  r->method = r->second_method = "files";
  r->times = arrays.at("times").values;
  r->gap = arrays.at("gap").values;
  r->gap_max = arrays.at("gap_max").values;
  r->positions = path_of(arrays.at("positions"), type->reference);
  if (const std::string why = mismatch(*r); !why.empty())
    throw UsageError("'" + type->reference + "': " + why);
  if (!r->positions.empty()) r->valid_until = r->times[r->positions.size() - 1];
  return std::abs(r->duration() - complete.at("duration")) < sample_interval ? r : nullptr;
}

// Durations differ where names do not.
std::string key_of(const std::string& name, const SceneParameters& complete) {
  return name + " " + number_text(complete.at("duration"));
}

}  // namespace

int Reference::samples_at(double level) const {
  int samples = 0;
  for (std::size_t i = 0; i < positions.size(); ++i) samples += sure_gaps * gap[i] <= level ? 1 : 0;
  return samples;
}

double Reference::known_until(double level) const {
  double until = 0;
  for (std::size_t i = 0; i < positions.size(); ++i)
    if (sure_gaps * gap[i] <= level) until = times[i];
  return until;
}

std::string Reference::name() const { return exact ? "exact" : reference_name(scene, parameters); }

double rms_distance(const Scene& scene, const Positions& x, const Positions& y) {
  double sum = 0;  // term by term, so that equal runs have equal errors to the last digit
  for (Eigen::Index i = 0; i < x.cols(); ++i)
    sum += scene.problem->mass()[i] * (x.col(i) - y.col(i)).squaredNorm();
  return std::sqrt(sum / scene.problem->total_mass()) / scene.size;
}

double max_distance(const Scene& scene, const Positions& x, const Positions& y) {
  return std::sqrt((x - y).colwise().squaredNorm().maxCoeff()) / scene.size;
}

std::vector<double> sample_times(double duration) {
  std::vector<double> times;
  for (int k = 1; k * sample_interval <= duration * (1 + 1e-9); ++k)
    times.push_back(k * sample_interval);
  return times;
}

std::string reference_name(const std::string& scene, const SceneParameters& complete) {
  const auto type = find_scene(scene);
  std::string changed;
  for (const auto& info : type->parameters) {
    const std::string name = info.name;
    if (name == type->resolution || name == "duration") continue;
    if (complete.at(name) != info.initial)
      changed += name + "=" + number_text(complete.at(name)) + ";";
  }
  return (type->identity.empty() ? scene : "mesh-" + type->identity) + "-n" +
         number_text(complete.at(type->resolution)) +
         (changed.empty() ? "" : "-" + fnv1a(changed)) + ".json";
}

json rows_of(const Path& path, double per_metre) {
  json rows = json::array();
  for (const Positions& x : path) {
    std::vector<double> row(x.data(), x.data() + x.size());
    if (per_metre > 0)
      for (double& value : row) value = std::round(value * per_metre) / per_metre;
    rows.push_back(std::move(row));
  }
  return rows;
}

Path path_of(const json& rows) {
  Path path;
  for (const json& row : rows) {
    const auto numbers = row.get<std::vector<double>>();
    path.emplace_back(Eigen::Map<const Positions>(numbers.data(), 3,
                                                  static_cast<Eigen::Index>(numbers.size() / 3)));
  }
  return path;
}

NumberArray array_of(const Path& path) {
  NumberArray array{{path.size(), static_cast<std::size_t>(path.empty() ? 0 : path[0].cols()), 3},
                    {}};
  for (const Positions& x : path)
    array.values.insert(array.values.end(), x.data(), x.data() + x.size());
  return array;
}

Path path_of(const NumberArray& array, const std::string& file) {
  if (array.shape.size() != 3 || array.shape[2] != 3)
    throw UsageError("'" + file + "': 'positions' must be of frames x vertices x 3 numbers");
  const auto vertices = static_cast<Eigen::Index>(array.shape[1]);
  Path path;
  for (std::size_t k = 0; k < array.shape[0]; ++k)
    path.emplace_back(
        Eigen::Map<const Positions>(array.values.data() + k * 3 * array.shape[1], 3, vertices));
  return path;
}

NumberArrays arrays_of(const Reference& r) {
  return {{"times", {{r.times.size()}, r.times}},
          {"positions", array_of(r.positions)},
          {"gap", {{r.gap.size()}, r.gap}},
          {"gap_max", {{r.gap_max.size()}, r.gap_max}}};
}

json to_json(const Reference& r) {
  json object = {{"schema", reference_schema}};
  write_fields(object, reference_fields, r);
  // A file holds only digits above the reference's uncertainty.
  const double least = r.gap.empty() ? 0 : *std::min_element(r.gap.begin(), r.gap.end());
  object["positions"] = rows_of(r.positions, least > 1e-7 ? 1e9 : 1e12);
  return object;
}

Reference read_reference(const std::string& path, const std::string& scene) {
  return reference_of(parse_document(read_file(path, "reference"), path), path, scene);
}

Reference reference_of(const json& document, const std::string& path, const std::string& scene) {
  try {
    if (document.at("schema") != reference_schema)
      throw UsageError("'" + path + "': schema is " + value_text(document.at("schema")) +
                       ", must be \"" + reference_schema + "\"");
    Reference r;
    read_fields(document, reference_fields, r);
    if (!scene.empty()) r.scene = scene;
    r.positions = path_of(document.at("positions"));
    const std::string why = mismatch(r);
    if (!why.empty()) throw UsageError("'" + path + "': " + why);
    return r;
  } catch (const json::exception& error) {
    throw UsageError("'" + path + "' is not a reference: " + error.what());
  }
}

std::string reference_path(const std::string& scene, const SceneParameters& complete) {
  const bool own = is_installed() || !find_scene(scene)->identity.empty();
  return (own ? local_place("references") : source_path("results/references")) + "/" +
         reference_name(scene, complete);
}

std::shared_ptr<ReferenceFolder> ReferenceFolder::usual() {
  return std::make_shared<ReferenceFolder>(
      std::vector{local_place("references"), source_path("results/references")});
}

std::shared_ptr<const Reference> ReferenceFolder::find(const std::string& scene,
                                                       const SceneParameters& complete) {
  const std::string name = reference_name(scene, complete);
  auto [place, fresh] = known_.try_emplace(key_of(name, complete), nullptr);
  if (fresh) place->second = exact_reference(scene, complete);
  if (fresh && !place->second) place->second = reference_from_files(scene, complete);
  for (const std::string& folder : folders_) {
    const std::string path = folder + "/" + name;
    if (!fresh || place->second || !std::filesystem::exists(path)) continue;
    auto stored = std::make_shared<const Reference>(read_reference(path, scene));
    // A file written before a parameter or its default changed describes another motion.
    if (stored->name() == name) place->second = std::move(stored);
  }
  return place->second;
}

void ReferenceFolder::put(std::shared_ptr<const Reference> reference) {
  const std::string key = key_of(reference->name(), reference->parameters);
  known_[key] = std::move(reference);
}

json ReferenceFolder::summaries() const {
  json list = json::array();
  for (const auto& [name, reference] : known_)
    if (reference) list.push_back(summary_of(*reference));
  return list;
}

}  // namespace harness
