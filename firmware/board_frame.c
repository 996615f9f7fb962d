#include "board_frame.h"

enum { CRC_SIZE = 4 };
enum { BETWEEN = 0, INSIDE, SPOILED }; /* states of the decoder */

uint32_t board_crc32(const uint8_t* bytes, uint8_t size) {
  uint32_t crc = 0xFFFFFFFFu;
  for (uint8_t i = 0; i < size; ++i) {
    crc ^= bytes[i];
    for (uint8_t bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1u) != 0 ? 0xEDB88320u : 0u);
  }
  return ~crc;
}

uint8_t board_encode(const uint8_t* body, uint8_t size, uint8_t* frame) {
  if (size == 0 || size > BOARD_MAX_BODY) return 0;
  const uint32_t crc = board_crc32(body, size);
  uint8_t count = 1;
  uint8_t code_at = 0; /* of the block that is being written; blocks are shorter than 254 bytes */
  for (uint8_t i = 0; i < size + CRC_SIZE; ++i) {
    const uint8_t byte = (uint8_t)(i < size ? body[i] : crc >> (8u * (unsigned)(i - size)));
    if (byte == 0) {
      frame[code_at] = (uint8_t)(count - code_at);
      code_at = count;
    }
    frame[count++] = byte;
  }
  frame[code_at] = (uint8_t)(count - code_at);
  frame[count++] = 0;
  return count;
}

static uint8_t judged(struct board_decoder* decoder) {
  const uint8_t state = decoder->state;
  const uint8_t size = decoder->size;
  decoder->state = BETWEEN;
  decoder->size = 0;
  if (state == BETWEEN) return 0; /* zeros between frames */
  if (state != SPOILED && decoder->left == 0 && size > CRC_SIZE) {
    const uint8_t body_size = (uint8_t)(size - CRC_SIZE);
    uint32_t crc = 0;
    for (uint8_t i = 0; i < CRC_SIZE; ++i) crc |= (uint32_t)decoder->body[body_size + i] << (8u * i);
    if (crc == board_crc32(decoder->body, body_size)) return body_size;
  }
  ++decoder->bad;
  return 0;
}

uint8_t board_decode(struct board_decoder* decoder, uint8_t byte) {
  if (byte == 0) return judged(decoder);
  if (decoder->state == SPOILED) return 0;
  const uint8_t is_code = decoder->state == BETWEEN || decoder->left == 0;
  if (!is_code) --decoder->left;
  if (is_code) decoder->left = (uint8_t)(byte - 1);
  if (is_code && decoder->state == BETWEEN) {
    decoder->state = INSIDE;
    return 0;
  }
  if (decoder->size >= BOARD_MAX_BODY + CRC_SIZE) {
    decoder->state = SPOILED;
    return 0;
  }
  decoder->body[decoder->size++] = is_code ? 0 : byte;
  return 0;
}
