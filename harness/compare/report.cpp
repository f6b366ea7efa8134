// The printers of a comparison: terminal and JUnit XML.
#include <unordered_map>

#include "harness/base/table.h"
#include "harness/base/text.h"
#include "harness/compare/comparison.h"

namespace harness {
namespace {

bool fails(Change change) { return is_failure(change) || is_regression(change); }

std::vector<PointChange> rows_of(const Comparison& comparison) {
  std::vector<PointChange> rows = comparison.points;
  std::erase_if(rows,
                [](const PointChange& point) {  // SAME with a reason: the gate only reports it
                  return point.too_few || (point.change == Change::same && point.reasons.empty());
                });
  std::ranges::stable_sort(rows, {}, &PointChange::change);
  return rows;
}

std::string counts(const Comparison& comparison) {
  std::string text;
  for (std::size_t i = 0; i < change_names.size(); ++i)
    if (const std::size_t n = comparison.count(static_cast<Change>(i)); n > 0)
      append(text, std::to_string(n) + " " + change_names[i]);
  return std::to_string(comparison.points.size()) + " points: " + text;
}

// Points with too few runs to decide on their times share one note.
std::vector<std::string> all_notes(const Comparison& comparison) {
  std::vector<std::string> notes = comparison.notes;
  const auto& points = comparison.points;
  const auto too_few = [](const PointChange& point) { return point.too_few; };
  const auto example = std::ranges::find_if(points, too_few);
  if (example != points.end())
    notes.push_back(std::to_string(std::count_if(example, points.end(), too_few)) +
                    " of the AMBIGUOUS have too few runs, for example " + example->id + ": " +
                    example->text());
  return notes;
}

// Control characters have no place in XML 1.0, not even escaped.
std::string xml(const std::string& text) {
  static const std::unordered_map<char, std::string> escapes{
      {'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}, {'\n', "&#10;"}};
  std::string result;
  for (const char c : text)
    if (const auto found = escapes.find(c); found != escapes.end())
      result += found->second;
    else
      result += static_cast<unsigned char>(c) < 0x20 ? '?' : c;
  return result;
}

// "drape/icd/n:225/..." of sweep strain: class strain.drape.icd.
std::string class_name(const PointChange& point) {
  const auto scene = point.id.find('/'), solver = point.id.find('/', scene + 1);
  std::string name = point.sweep + "." + point.id.substr(0, solver);
  std::replace(name.begin(), name.end(), '/', '.');
  return name;
}

}  // namespace

void print_comparison(std::ostream& out, const Comparison& comparison) {
  Table table;
  for (const PointChange& row : rows_of(comparison))
    table.rows.push_back({to_string(row.change), row.sweep + " " + row.id, row.text()});
  print_aligned(out, table);
  if (!table.rows.empty()) out << '\n';
  for (const std::string& note : all_notes(comparison)) out << "note: " << note << '\n';
  out << counts(comparison) << std::endl;
}

std::string junit_xml(const Comparison& comparison, const std::string& name) {
  std::ostringstream cases;
  int failures = 0;
  for (const PointChange& point : comparison.points) {
    const std::string change = to_string(point.change), what = xml(change + ": " + point.text());
    cases << "<testcase classname=\"" << xml(class_name(point)) << "\" name=\"" << xml(point.id)
          << "\"";
    if (fails(point.change)) {
      ++failures;
      cases << "><failure type=\"" << change << "\" message=\"" << what << "\"/></testcase>\n";
    } else if (point.change != Change::same || !point.reasons.empty()) {
      cases << "><system-out>" << what << "</system-out></testcase>\n";
    } else {
      cases << "/>\n";
    }
  }
  const std::string totals = " tests=\"" + std::to_string(comparison.points.size()) +
                             "\" failures=\"" + std::to_string(failures) + "\" errors=\"0\"";
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites" + totals +
         ">\n<testsuite name=\"" + xml(name) + "\"" + totals + ">\n" + cases.str() +
         "</testsuite>\n</testsuites>\n";
}

}  // namespace harness
