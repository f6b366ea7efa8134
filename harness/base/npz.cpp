// An .npz file is a zip archive of .npy files: a header, a dictionary in Python's notation, and the
// numbers (numpy.lib.format).
#include "harness/base/npz.h"

#include <re2/re2.h>
#include <zip.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <functional>
#include <numeric>
#include <optional>

#include "harness/base/text.h"

namespace harness {
namespace {

constexpr std::string_view magic("\x93NUMPY", 6);
constexpr std::size_t largest = std::size_t{1} << 34;  // bytes of an array

template <class Number>
std::vector<double> numbers_of(std::string_view bytes) {
  std::vector<Number> numbers(bytes.size() / sizeof(Number));
  std::memcpy(numbers.data(), bytes.data(), numbers.size() * sizeof(Number));
  return {numbers.begin(), numbers.end()};
}

// None for numbers of another type. Throws std::invalid_argument, saying what is wrong.
std::optional<NumberArray> array_of(const std::string& npy) {
  const auto require = [](bool fits, const char* what) {
    if (!fits) throw std::invalid_argument(what);
  };
  require(npy.size() >= 12 && npy.starts_with(magic), "is not an array of NumPy");
  std::uint32_t length = 0;  // of the header; version 1 has two bytes, later ones four
  const std::size_t width = npy[6] == 1 ? 2 : 4;
  std::memcpy(&length, npy.data() + 8, width);
  const std::size_t begin = 8 + width + length;
  require(begin <= npy.size(), "ends within its header");
  const std::string header = npy.substr(8 + width, length);
  static const RE2 form(
      R"('descr': '[<|=]?([fi][1248])', 'fortran_order': (True|False), 'shape': \(([0-9, ]*)\))");
  std::string type, order, shape;
  if (!RE2::PartialMatch(header, form, &type, &order, &shape)) return {};
  require(order == "False", "is in Fortran order; numpy.ascontiguousarray turns it");
  NumberArray array;
  std::ranges::replace(shape, ',', ' ');
  std::istringstream sizes(shape);
  for (std::size_t size = 0; sizes >> size;) array.shape.push_back(size);
  static const std::map<std::string, std::function<std::vector<double>(std::string_view)>> readers{
      {"f8", numbers_of<double>},       {"f4", numbers_of<float>},
      {"i8", numbers_of<std::int64_t>}, {"i4", numbers_of<std::int32_t>},
      {"i2", numbers_of<std::int16_t>}, {"i1", numbers_of<std::int8_t>}};
  if (!readers.contains(type)) return {};
  array.values = readers.at(type)(std::string_view(npy).substr(begin));
  const auto count =
      std::accumulate(array.shape.begin(), array.shape.end(), std::size_t{1}, std::multiplies<>());
  require(array.values.size() == count, "has more or fewer numbers than its shape says");
  return array;
}

std::string npy_bytes(const NumberArray& array) {
  std::string header = "{'descr': '<f8', 'fortran_order': False, 'shape': (";
  for (const std::size_t size : array.shape) header += std::to_string(size) + ",";
  header += "), }";
  header.resize((header.size() + 11 + 63) / 64 * 64 - 11, ' ');  // numbers begin at a multiple
  header += '\n';
  const auto length = static_cast<std::uint16_t>(header.size());
  std::string bytes = std::string(magic) + std::string("\1\0", 2);
  bytes.append(reinterpret_cast<const char*>(&length), sizeof length).append(header);
  return bytes.append(reinterpret_cast<const char*>(array.values.data()),
                      array.values.size() * sizeof(double));
}

using Archive = std::unique_ptr<zip_t, decltype(&zip_discard)>;

}  // namespace

NumberArrays read_npz(const std::string& path) {
  const Archive archive(zip_open(path.c_str(), ZIP_RDONLY, nullptr), zip_discard);
  if (!archive) throw UsageError("'" + path + "' is not an .npz file of NumPy");
  NumberArrays arrays;
  for (zip_int64_t i = 0; i < zip_get_num_entries(archive.get(), 0); ++i) {
    zip_stat_t entry;
    if (zip_stat_index(archive.get(), i, 0, &entry) != 0) continue;
    std::string name = entry.name;
    if (!name.ends_with(".npy") || entry.size > largest) continue;
    name.resize(name.size() - 4);
    std::string bytes(entry.size, '\0');
    const std::unique_ptr<zip_file_t, decltype(&zip_fclose)> file(
        zip_fopen_index(archive.get(), i, 0), zip_fclose);
    if (!file ||
        zip_fread(file.get(), bytes.data(), bytes.size()) != static_cast<zip_int64_t>(bytes.size()))
      throw UsageError("'" + path + "': array '" + shortened(name) + "' is damaged");
    try {
      if (auto array = array_of(bytes)) arrays[name] = std::move(*array);
    } catch (const std::invalid_argument& error) {
      throw UsageError("'" + path + "': array '" + shortened(name) + "' " + error.what());
    }
  }
  if (arrays.empty()) throw UsageError("'" + path + "' has no array of float or int numbers");
  return arrays;
}

std::string npz_bytes(const NumberArrays& arrays) {
  zip_source_t* memory = zip_source_buffer_create(nullptr, 0, 0, nullptr);
  zip_source_keep(memory);  // past the archive
  const std::unique_ptr<zip_source_t, decltype(&zip_source_free)> kept(memory, zip_source_free);
  zip_t* archive = zip_open_from_source(memory, ZIP_TRUNCATE, nullptr);
  std::vector<std::string> files;  // libzip reads them as it closes the archive
  files.reserve(arrays.size());
  for (const auto& [name, array] : arrays) {
    const std::string& bytes = files.emplace_back(npy_bytes(array));
    const zip_int64_t at =
        zip_file_add(archive, (name + ".npy").c_str(),
                     zip_source_buffer(archive, bytes.data(), bytes.size(), 0), ZIP_FL_ENC_UTF_8);
    zip_set_file_compression(archive, static_cast<zip_uint64_t>(at), ZIP_CM_STORE, 0);
    zip_file_set_mtime(archive, static_cast<zip_uint64_t>(at), 315532800, 0);  // the same bytes
  }
  if (zip_close(archive) != 0) throw std::runtime_error("cannot make an .npz file");
  zip_stat_t made;
  zip_source_stat(memory, &made);
  std::string bytes(made.size, '\0');
  zip_source_open(memory);
  zip_source_read(memory, bytes.data(), bytes.size());
  zip_source_close(memory);
  return bytes;
}

}  // namespace harness
