// Nothing: CMake wants a source for the target that compiles the shared headers.
