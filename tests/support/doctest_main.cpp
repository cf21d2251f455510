// The main function of every test program.
#include <doctest/doctest.h>
