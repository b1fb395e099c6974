#include "server/operate/tls_files.h"

#include <cerrno>
#include <cstring>
#include <ctime>
#include <fstream>
#include <iterator>
#include <memory>
#include <string_view>
#include <vector>

#include <absl/time/time.h>
#include <fmt/format.h>
#include <openssl/bio.h>
#include <openssl/err.h>
#include <openssl/pem.h>
#include <openssl/x509.h>

#include "core/base/status.h"

namespace patchmill {
namespace {

constexpr std::size_t kMaxPemBytes = std::size_t{1} << 20;

struct FreeX509 {
  void operator()(X509* certificate) const { X509_free(certificate); }
};
using Certificate = std::unique_ptr<X509, FreeX509>;
using Bio = std::unique_ptr<BIO, decltype(&BIO_free)>;
using Key = std::unique_ptr<EVP_PKEY, decltype(&EVP_PKEY_free)>;

absl::Status Fault(std::string_view option, const std::string& path, std::string_view text) {
  return absl::InvalidArgumentError(fmt::format("{} {}: {}", option, path, text));
}

absl::StatusOr<std::string> ReadPem(std::string_view option, const std::string& path) {
  errno = 0;
  std::ifstream in(path, std::ios::binary);
  if (!in) return Fault(option, path, fmt::format("cannot be read: {}", std::strerror(errno)));
  std::string text(kMaxPemBytes, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (in.bad()) return Fault(option, path, fmt::format("cannot be read: {}", std::strerror(errno)));
  text.resize(static_cast<std::size_t>(in.gcount()));
  if (text.empty()) return Fault(option, path, "is empty, or is no file");
  return text;
}

Bio BioOf(const std::string& text) {
  return {BIO_new_mem_buf(text.data(), static_cast<int>(text.size())), &BIO_free};
}

bool Has(const std::string& pem, std::string_view what) {
  for (std::size_t at = pem.find("-----BEGIN "); at != pem.npos; at = pem.find("-----BEGIN ", at + 1)) {
    const std::string_view label = std::string_view(pem).substr(at, pem.find('\n', at) - at);
    if (label.find(what) != label.npos) return true;
  }
  return false;
}

absl::StatusOr<std::vector<Certificate>> CertificatesOf(std::string_view option, const std::string& path,
                                                        const std::string& pem) {
  const Bio bio = BioOf(pem);
  std::vector<Certificate> found;
  while (X509* certificate = PEM_read_bio_X509(bio.get(), nullptr, nullptr, nullptr))
    found.emplace_back(certificate);
  ERR_clear_error();  // the end of the text is an error to OpenSSL
  if (!found.empty()) return found;
  if (Has(pem, "PRIVATE KEY"))
    return Fault(option, path, "holds a private key; a certificate belongs here (PEM)");
  if (Has(pem, "CERTIFICATE")) return Fault(option, path, "its certificate is damaged");
  return Fault(option, path, "holds no certificate in PEM form (-----BEGIN CERTIFICATE-----)");
}

absl::Time TimeOf(const ASN1_TIME* time) {
  std::tm civil{};
  if (ASN1_TIME_to_tm(time, &civil) != 1) return absl::InfiniteFuture();
  return absl::FromTM(civil, absl::UTCTimeZone());
}

std::string Text(absl::Time time) { return absl::FormatTime(absl::RFC3339_sec, time, absl::UTCTimeZone()); }

// Whether a certificate is good now, by the clock of this machine.
absl::Status CheckTime(const X509& certificate, std::string_view option, const std::string& path) {
  const absl::Time now = absl::Now();
  const absl::Time from = TimeOf(X509_get0_notBefore(&certificate)),
                   until = TimeOf(X509_get0_notAfter(&certificate));
  if (now >= until)
    return Fault(option, path, fmt::format("the certificate expired at {}; renew it", Text(until)));
  if (now < from) {
    return Fault(option, path,
                 fmt::format("the certificate is not valid before {}; is the clock of this machine right?",
                             Text(from)));
  }
  return absl::OkStatus();
}

absl::StatusOr<Key> KeyOf(const std::string& path, const std::string& pem) {
  const Bio bio = BioOf(pem);
  // No question for a password on the terminal.
  const auto no_password = [](char*, int, int, void*) { return -1; };
  Key key(PEM_read_bio_PrivateKey(bio.get(), nullptr, no_password, nullptr), &EVP_PKEY_free);
  ERR_clear_error();
  if (key) return key;
  if (Has(pem, "ENCRYPTED") || pem.find("Proc-Type: 4,ENCRYPTED") != pem.npos) {
    return Fault("--key", path, "the key is encrypted; write it without a password (openssl pkey -in FILE)");
  }
  if (Has(pem, "PRIVATE KEY")) return Fault("--key", path, "its private key is damaged");
  if (Has(pem, "CERTIFICATE"))
    return Fault("--key", path, "holds a certificate; a private key belongs here (PEM)");
  return Fault("--key", path, "holds no private key in PEM form (-----BEGIN PRIVATE KEY-----)");
}

}  // namespace

absl::StatusOr<TlsFiles> ReadTlsFiles(const TlsPaths& paths) {
  TlsFiles files;
  PM_ASSIGN_OR_RETURN(files.cert, ReadPem("--cert", paths.cert));
  PM_ASSIGN_OR_RETURN(files.key, ReadPem("--key", paths.key));
  PM_ASSIGN_OR_RETURN(const std::vector<Certificate> chain, CertificatesOf("--cert", paths.cert, files.cert));
  PM_ASSIGN_OR_RETURN(const Key key, KeyOf(paths.key, files.key));
  for (const Certificate& certificate : chain)
    PM_RETURN_IF_ERROR(CheckTime(*certificate, "--cert", paths.cert));
  const bool matches = X509_check_private_key(chain.front().get(), key.get()) == 1;
  ERR_clear_error();
  if (!matches) {
    return Fault("--key", paths.key,
                 fmt::format("the key is not that of the first certificate in --cert {}", paths.cert));
  }
  files.until = absl::ToChronoTime(TimeOf(X509_get0_notAfter(chain.front().get())));
  if (paths.ca.empty()) return files;
  PM_ASSIGN_OR_RETURN(files.ca, ReadPem("--ca", paths.ca));
  PM_ASSIGN_OR_RETURN(const std::vector<Certificate> authorities, CertificatesOf("--ca", paths.ca, files.ca));
  absl::Status expired;
  for (const Certificate& authority : authorities) {
    const absl::Status good = CheckTime(*authority, "--ca", paths.ca);
    if (good.ok()) return files;
    expired = good;
  }
  return expired;
}

}  // namespace patchmill
