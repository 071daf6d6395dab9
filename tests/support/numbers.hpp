// Numbers from standard input, as the programs of the tests read them.
#pragma once
#include <cstdio>

template <class T>
bool read(T* to, int count, const char* format) {
  for (int i = 0; i < count; ++i)
    if (std::scanf(format, to + i) != 1) return false;
  return true;
}
