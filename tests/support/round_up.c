/* Loaded before a program: another library that leaves its direction of rounding behind. */
#include <fenv.h>

__attribute__((constructor)) static void round_up(void) {
    fesetround(FE_UPWARD);
}
