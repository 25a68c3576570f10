#include "timbre/analysis/core/sha256.h"

#include <openssl/evp.h>

#include <new>

#include "timbre/analysis/core/error.h"

namespace timbre {

struct Sha256::Impl {
  EVP_MD_CTX* context = EVP_MD_CTX_new();
  ~Impl() { EVP_MD_CTX_free(context); }
};

Sha256::Sha256() : impl_(std::make_unique<Impl>()) {
  if (impl_->context == nullptr) throw std::bad_alloc();
  if (EVP_DigestInit_ex(impl_->context, EVP_sha256(), nullptr) != 1) {
    throw Error(ErrorKind::io, "", "checksum", "libcrypto offers no SHA-256");
  }
}

Sha256::~Sha256() = default;

void Sha256::add_bytes(std::span<const std::byte> bytes) {
  if (EVP_DigestUpdate(impl_->context, bytes.data(), bytes.size()) != 1) {
    throw Error(ErrorKind::io, "", "checksum", "libcrypto failed");
  }
}

void Sha256::add_text(std::string_view text) {
  const std::string length = std::to_string(text.size()) + ":";
  add_bytes(std::as_bytes(std::span(length)));
  add_bytes(std::as_bytes(std::span(text)));
}

Sha256Digest Sha256::finish() {
  Sha256Digest digest{};
  if (EVP_DigestFinal_ex(impl_->context, digest.data(), nullptr) != 1) {
    throw Error(ErrorKind::io, "", "checksum", "libcrypto failed");
  }
  return digest;
}

std::string to_hex(const Sha256Digest& digest) {
  static constexpr char kHex[] = "0123456789abcdef";
  std::string out;
  for (const std::uint8_t byte : digest) {
    out += kHex[byte >> 4];
    out += kHex[byte & 15];
  }
  return out;
}

}  // namespace timbre
