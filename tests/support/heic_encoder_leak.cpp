// The encoder of HEIC, which only tests call, keeps some memory.
extern "C" const char* __lsan_default_suppressions() {
    return "leak:libx265\n";
}
