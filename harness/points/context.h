// What produced the numbers: machine, build, libraries.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace harness {

// Google Benchmark's keys, and "build", "libraries", "fingerprint" (equal for one build of one
// commit on one kind of machine), "counters_fingerprint"; "plugins" where some are loaded.
nlohmann::json machine_context();

// Equal where work counters may be compared exactly, because the code that computes is the same:
// compiler, flags, libraries; with -march=native the kind of machine too. Not the commit, whose
// effect a comparison is to show.
std::string counters_fingerprint();

// One thread, whatever the environment says, in OpenBLAS and in CHOLMOD's own OpenMP loops (which
// ask for four): a comparison of methods, not of thread pools. OpenBLAS starts its threads before
// main, and waits for them forever where they find no memory: the program starts itself again.
void use_one_thread(char** argv);

const char* version();

// The first difference, in words: "compiler is 'GNU 13', was 'GNU 12'"; "" if there is none.
std::string difference(const nlohmann::json& was, const nlohmann::json& is);

}  // namespace harness
