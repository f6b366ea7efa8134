#include "harness/compare/comparison_report.h"

#include <algorithm>
#include <array>
#include <iomanip>
#include <sstream>

namespace harness {
namespace {

// From what matters most; the table's order too.
constexpr std::array order{Change::newly_failing, Change::missing,   Change::slower,
                           Change::changed,       Change::ambiguous, Change::fixed,
                           Change::faster,        Change::added,     Change::same};

std::vector<const PointChange*> sorted_changes(const Comparison& comparison) {
  std::vector<const PointChange*> list;
  for (const Change change : order) {
    for (const PointChange& point : comparison.points) {
      // SAME with a reason: a difference that the gate only wants told.
      if (point.change == change && !point.too_few &&
          (change != Change::same || !point.reasons.empty()))
        list.push_back(&point);
    }
  }
  return list;
}

std::string counts(const Comparison& comparison) {
  std::string text = std::to_string(comparison.points.size()) + " points: ";
  std::string separator;
  for (const Change change : order) {
    if (const std::size_t n = comparison.count(change); n > 0) {
      text += separator + std::to_string(n) + " " + to_string(change);
      separator = ", ";
    }
  }
  return text;
}

// One line for all points that differ in time and have too few runs to say whether they really do.
std::vector<std::string> all_notes(const Comparison& comparison) {
  std::vector<std::string> notes = comparison.notes;
  const auto few = std::count_if(comparison.points.begin(), comparison.points.end(),
                                 [](const PointChange& point) { return point.too_few; });
  if (few > 0) {
    const auto example = std::find_if(comparison.points.begin(), comparison.points.end(),
                                      [](const PointChange& point) { return point.too_few; });
    notes.push_back(std::to_string(few) + " of the AMBIGUOUS have too few runs, for example " +
                    example->id + ": " + example->text());
  }
  return notes;
}

bool fails(Change change) { return is_failure(change) || is_regression(change); }

// Control characters have no place in XML 1.0, not even escaped.
std::string xml(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      case '\n':
        result += "&#10;";
        break;
      default:
        result += static_cast<unsigned char>(c) < 0x20 ? '?' : c;
    }
  }
  return result;
}

// Inside a cell: no line may end, no cell may end, and nothing is a tag.
std::string cell(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '|' || c == '*' || c == '_' || c == '`' || c == '\\') result += '\\';
    if (c == '<') {
      result += "&lt;";
    } else if (c == '&') {
      result += "&amp;";
    } else {
      result += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
  }
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
  const auto list = sorted_changes(comparison);
  std::size_t width = 0;
  for (const PointChange* point : list)
    width = std::max(width, point->sweep.size() + point->id.size() + 3);
  for (const PointChange* point : list) {
    out << std::left << std::setw(14) << to_string(point->change)
        << std::setw(static_cast<int>(width)) << point->sweep + " " + point->id << point->text()
        << '\n';
  }
  if (!list.empty()) out << '\n';
  for (const std::string& note : all_notes(comparison)) out << "note: " << note << '\n';
  out << counts(comparison) << std::endl;
}

std::string junit_xml(const Comparison& comparison, const std::string& name) {
  const auto failures = std::count_if(comparison.points.begin(), comparison.points.end(),
                                      [](const PointChange& point) { return fails(point.change); });
  std::ostringstream text;
  const std::string totals = " tests=\"" + std::to_string(comparison.points.size()) +
                             "\" failures=\"" + std::to_string(failures) + "\" errors=\"0\"";
  text << "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites" << totals
       << ">\n<testsuite name=\"" << xml(name) << "\"" << totals << ">\n";
  for (const PointChange& point : comparison.points) {
    text << "<testcase classname=\"" << xml(class_name(point)) << "\" name=\"" << xml(point.id)
         << "\"";
    const std::string change = to_string(point.change);
    if (fails(point.change)) {
      text << "><failure type=\"" << change << "\" message=\"" << xml(change + ": " + point.text())
           << "\"/></testcase>\n";
    } else if (point.change != Change::same || !point.reasons.empty()) {
      text << "><system-out>" << xml(change + ": " + point.text()) << "</system-out></testcase>\n";
    } else {
      text << "/>\n";
    }
  }
  text << "</testsuite>\n</testsuites>\n";
  return text.str();
}

std::string markdown_table(const Comparison& comparison, const std::string& title) {
  std::string text = "### " + cell(title) + "\n\n" + counts(comparison) + "\n";
  const auto list = sorted_changes(comparison);
  if (!list.empty()) text += "\n| change | sweep | point | what |\n|---|---|---|---|\n";
  for (const PointChange* point : list) {
    const std::string change = cell(to_string(point->change));
    text += "| " + (fails(point->change) ? "**" + change + "**" : change) + " | " +
            cell(point->sweep) + " | " + cell(point->id) + " | " + cell(point->text()) + " |\n";
  }
  for (const std::string& note : all_notes(comparison)) text += "\nNote: " + cell(note) + "\n";
  return text;
}

}  // namespace harness
