// libFuzzer target for suites and result files: cmake --preset fuzz, then
//   build/fuzz/tests/fuzz_documents -max_total_time=60 corpus/ configs/
#include "harness/points/fuzz_documents.h"

#include <cstddef>
#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  harness::testing::read_as_suite(text);
  harness::testing::read_as_result(text);
  return 0;
}
