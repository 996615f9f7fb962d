"""The certificate of the console: one that is given, or one that it makes itself."""

import hashlib
import ssl
import subprocess
from pathlib import Path

DAYS = "825"
"""of a certificate that is made here; browsers accept no more"""


class TlsError(RuntimeError):
    """There is no certificate that can be used; the message says why."""


def context_of(certificate: Path, key: Path) -> ssl.SSLContext:
    """Raises TlsError."""
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    context.minimum_version = ssl.TLSVersion.TLSv1_2
    try:
        context.load_cert_chain(certificate, key)
    except (OSError, ssl.SSLError) as error:
        raise TlsError(f"--cert {certificate} --key {key}: {error}") from None
    return context


def self_made(folder: Path, names: list[str]) -> tuple[Path, Path]:
    """Certificate and key in this folder, made once for these names and addresses. Raises TlsError."""
    certificate, key = folder / "console_cert.pem", folder / "console_key.pem"
    if certificate.exists() and key.exists():
        return certificate, key
    folder.mkdir(parents=True, exist_ok=True)
    listed = ",".join(f"{'IP' if name.replace('.', '').isdigit() or ':' in name else 'DNS'}:{name}" for name in names)
    command = ["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-nodes"]
    command += ["-days", DAYS, "-subj", "/CN=robot_control console", "-addext", f"subjectAltName={listed}"]
    command += ["-keyout", str(key), "-out", str(certificate)]
    try:
        subprocess.run(command, check=True, capture_output=True, text=True, umask=0o077)
    except (OSError, subprocess.CalledProcessError) as error:
        reason = error.stderr.strip()[-300:] if isinstance(error, subprocess.CalledProcessError) else str(error)
        raise TlsError(f"openssl created no certificate (scripts/setup --console installs it): {reason}") from None
    return certificate, key


def fingerprint(certificate: Path) -> str:
    """SHA-256, as browsers show it."""
    digest = hashlib.sha256(ssl.PEM_cert_to_DER_cert(certificate.read_text())).hexdigest().upper()
    return ":".join(digest[at : at + 2] for at in range(0, len(digest), 2))
