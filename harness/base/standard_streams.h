// Standard input, output and error as a program may find them: closed, full, cut off.
#pragma once

namespace harness {

// Opens those of descriptors 0 to 2 that are closed, to where nothing can be read or written:
// otherwise the next file that is opened becomes one of them, and messages are written into it.
// First thing in main.
void open_standard_streams();

// Throws FileError if something that was printed did not get out. Last thing in main.
void check_standard_output();

}  // namespace harness
