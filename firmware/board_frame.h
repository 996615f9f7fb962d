#ifndef ROBOT_CONTROL_BOARD_FRAME_H
#define ROBOT_CONTROL_BOARD_FRAME_H
/* A frame is a body of bytes on a serial line:
 *
 *   COBS(body, CRC-32 of the body, least significant byte first), 0x00
 *
 * COBS (Cheshire and Baker, 1999) replaces every zero, so that 0x00 ends a frame and nothing else. The CRC is that of
 * IEEE 802.3: polynomial 0xEDB88320 reflected, begin and final XOR 0xFFFFFFFF. A frame has at most BOARD_MAX_FRAME bytes
 * on the line. docs/board_protocol.md specifies it for other implementations. */

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { BOARD_MAX_FRAME = 128 };                 /* bytes on the line, the final zero included */
enum { BOARD_MAX_BODY = BOARD_MAX_FRAME - 6 };  /* without CRC, the COBS byte and the final zero */

uint32_t board_crc32(const uint8_t* bytes, uint8_t size);

/* Writes a frame to `frame`, which has room for BOARD_MAX_FRAME bytes. Returns its size; 0 if the body is empty or has
 * more than BOARD_MAX_BODY bytes. */
uint8_t board_encode(const uint8_t* body, uint8_t size, uint8_t* frame);

/* Collects the bytes of a line and cuts them into frames. All members begin with zero. */
struct board_decoder {
  uint8_t body[BOARD_MAX_FRAME]; /* the body of the last good frame, until the next byte */
  uint8_t size;                  /* bytes collected; after a good frame the size of the body */
  uint8_t left;                  /* bytes until the next one that COBS replaced */
  uint8_t state;
  uint16_t bad; /* frames with an error, modulo 65536 */
};

/* Takes a byte of the line. Returns the size of the body if the byte ends a good frame, else 0. */
uint8_t board_decode(struct board_decoder* decoder, uint8_t byte);

#ifdef __cplusplus
}
#endif
#endif
