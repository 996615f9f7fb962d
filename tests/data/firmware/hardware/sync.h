// These are declarations of what docs/firmware_pico.md uses of the Pico SDK.
#pragma once
#include <stdint.h>

uint32_t save_and_disable_interrupts(void);
void restore_interrupts(uint32_t state);
