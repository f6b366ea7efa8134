// Standard input, output and error as a program may find them: closed, full, cut off.
#pragma once

#include <cstddef>

#include "harness/base/files.h"

namespace harness {

// Opens those of descriptors 0 to 2 that are closed, to where nothing can be read or written:
// otherwise the next file that is opened becomes one of them, and messages are written into it.
// First thing in main.
void open_standard_streams();

// While it lives, what is written to standard output goes to standard error: what foreign code
// prints is mixed with no result. Throws std::runtime_error if there is no descriptor left.
class OutputToError {
 public:
  OutputToError();
  ~OutputToError();

 private:
  OpenFile output_;
};

// The same to the end of this process.
void send_output_to_error();

// Columns of the terminal that standard output (or another stream) is; 120 where it is none.
std::size_t output_columns(int file = 1);

// Throws FileError if something that was printed did not get out. Last thing in main.
void check_standard_output();

}  // namespace harness
