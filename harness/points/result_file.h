// The result file, schema inextensible-bench/1 (configs/result.schema.json).
#pragma once

#include "harness/points/suite.h"

namespace harness {

// A point as a file has it: measured numbers have six digits, and errors no series. What decides
// what is run, and from where on, stays exact.
json row_of(PointResult point);

// context: machine_context() as it was before the sweep ran. references:
// ReferenceFolder::summaries().
json result_document(json context, const Suite& suite, const std::vector<std::string>& command,
                     bool complete, const std::vector<PointResult>& points,
                     json references = json::array());

// As it is written: one point a line.
std::string result_text(const json& document);

// false: it was made while others may have been timed, so its times mean nothing.
bool is_timed(const json& document);

// The kinds of documents that a reader accepts.
enum class ResultKinds { sweeps, answers, all };  // sweeps: stability sweeps, too
// Throws UsageError, naming the file, for a document of another kind, one that is not as its schema
// says, and one that no run can have made: times that are not those of their samples, say.
void check_result(const json& document, const std::string& path,
                  ResultKinds kinds = ResultKinds::sweeps);
// These replace characters that control a terminal.
json parse_result(const std::string& text, const std::string& path,
                  ResultKinds kinds = ResultKinds::sweeps);
json read_result(const std::string& path, ResultKinds kinds = ResultKinds::sweeps);
bool is_answers(const json& document);  // of `bench answers`

// A result, and what messages and tables call it.
struct NamedResult {
  std::string name;
  json document;
};

// Over all limits, sizes and levels of error at which both have a best point, in a step sweep over
// all steps at which both ran to the end: |log(time of one / time of the other)|. A difference
// below q95 is none.
struct PairNoise {
  std::array<std::string, 2> pair;  // contestants
  int places = 0;
  double median = 0, q95 = 0;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(PairNoise, pair, places, median, q95)

// The most q95 of a result, or of an occasion, that may be quoted.
constexpr double quotable_noise = 0.06;
// "equal programs differ by 7.1 % here, more than the 6 % ..."; "" if it may be quoted.
std::string why_not_quotable(const PairNoise& noise);

// None where `one` and double_of(one) have no place in common.
std::optional<PairNoise> pair_noise(const std::vector<PointResult>& points, const std::string& one);

// `context.noise` of a result file; none in files without a pair.
std::optional<PairNoise> noise_of(const json& context);

// documents: results of one kind (check_result), at least one. Points that belong to one search for
// a best step, or hard cases of one name, are taken from the first document that has any. The
// second contestant of an A/A pair is left out; the largest noise of all pairs counts for all. The
// rest of the context is the first one's. The table is complete if every document is. Throws
// UsageError for documents of different kinds.
json joined(const std::vector<json>& documents);

// The same of files; throws UsageError, naming the file, for what is no result.
json read_results(const std::vector<std::string>& paths);

}  // namespace harness
