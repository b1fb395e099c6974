"""Certificates made with openssl, as an operator makes them."""
import pathlib
import subprocess
from datetime import datetime, timedelta, timezone


def _openssl(*words: str) -> None:
    subprocess.run(["openssl", *words], check=True, capture_output=True)


class Authority:
    """An authority of its own in a folder, and what it signs."""

    def __init__(self, folder: pathlib.Path, name: str = "ca") -> None:
        self.folder, self.name = folder, name
        self.ca, self._key = str(folder / f"{name}.pem"), str(folder / f"{name}.key")
        _openssl("req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-nodes", "-days", "30",
                 "-subj", f"/CN={name}", "-keyout", self._key, "-out", self.ca)
        (folder / f"{name}.index").write_text("")
        (folder / f"{name}.serial").write_text("01")
        (folder / f"{name}.conf").write_text(
            f"[ca]\ndefault_ca = own\n[own]\ndatabase = {folder}/{name}.index\nserial = {folder}/{name}.serial\nnew_certs_dir = {folder}\n"
            "default_md = sha256\npolicy = any\nunique_subject = no\ncopy_extensions = copy\n[any]\ncommonName = supplied\n")

    def sign(self, name: str, days: float = 10.0, begins: float = -1.0, host: str = "localhost") -> tuple[str, str]:
        """Files of a new certificate and its key. It begins `begins` days from now and lasts `days`."""
        key, request, cert = (str(self.folder / f"{name}.{end}") for end in ("key", "csr", "pem"))
        _openssl("req", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-nodes", "-subj", f"/CN={name}",
                 "-addext", f"subjectAltName=DNS:{host},IP:127.0.0.1", "-keyout", key, "-out", request)
        start = datetime.now(timezone.utc) + timedelta(days=begins)
        end = start + timedelta(days=days)
        _openssl("ca", "-batch", "-notext", "-config", str(self.folder / f"{self.name}.conf"), "-cert", self.ca, "-keyfile", self._key,
                 "-startdate", start.strftime("%Y%m%d%H%M%SZ"), "-enddate", end.strftime("%Y%m%d%H%M%SZ"), "-in", request, "-out", cert)
        return cert, key
