#include "timbre/tests/fuzz/tested_format.h"

#define TIMBRE_TEXT_OF(name) #name
#define TIMBRE_TEXT(name) TIMBRE_TEXT_OF(name)

const char* const timbre::fuzz::tested_format = TIMBRE_TEXT(TIMBRE_FUZZ_FORMAT);
