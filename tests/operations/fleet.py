"""Several servers behind nginx, as deploy/nginx/patchmill.conf has them; and the Python package, to call
them."""
import importlib
import os
import pathlib
import re
import shutil
import signal
import socket
import subprocess
import sys
from typing import Any

from certificates import Authority
from support import ROOT, Server, wait_until

NGINX = shutil.which("nginx", path=os.environ.get("PATH", "") + ":/usr/sbin:/sbin")
SERVER_NAME = "patchmill.example"  # of the certificates behind nginx, as deploy/nginx/patchmill.conf expects it


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


def replaced(text: str, old: str, new: str) -> str:
    """The text with what must be in it replaced, so that a file that has changed is noticed."""
    assert old in text, f"deploy/nginx/patchmill.conf has no longer: {old}"
    return text.replace(old, new)


class Fleet:
    """Servers over TLS and nginx in front of them. `servers` are those that nginx knows."""

    def __init__(self, folder: pathlib.Path, tokens: str, *flags: str) -> None:
        self.folder = folder
        authority = Authority(folder)
        self.ca = authority.ca
        self._behind, self._front = authority.sign("behind", host=SERVER_NAME), authority.sign("front")
        self._flags = ("--cert", self._behind[0], "--key", self._behind[1], "--tokens", tokens, *flags)
        self._all: list[Server] = []
        self.servers: list[Server] = []
        self._nginx: subprocess.Popen[bytes] | None = None
        self.port = free_port()
        self.address = f"localhost:{self.port}"

    def __enter__(self) -> "Fleet":
        return self

    def __exit__(self, *_: object) -> None:
        if self._nginx is not None:
            self._nginx.terminate()
            self._nginx.wait()
        for server in self._all:
            server.__exit__()

    def start(self, *flags: str, listen: str = "127.0.0.1:0", program: pathlib.Path | None = None) -> Server:
        """One server more."""
        server = Server(*self._flags, *flags, listen=listen, program=program)
        self._all.append(server)
        return server

    def know(self, servers: list[Server]) -> None:
        """Tells nginx which servers there are, as an operator does: lines of the upstream, then a reload."""
        self.servers = list(servers)
        self._write()
        if self._nginx is None:
            self._run()
        else:
            self._nginx.send_signal(signal.SIGHUP)
            assert wait_until(lambda: self._workers_of_now()), self.nginx_log()

    def nginx_log(self) -> str:
        path = self.folder / "nginx.log"
        return path.read_text() if path.exists() else ""

    def _workers_of_now(self) -> bool:
        # The old workers say so when they begin to end.
        return self.nginx_log().count("gracefully shutting down") >= self._reloads()

    def _reloads(self) -> int:
        return self.nginx_log().count("reconfiguring")

    def _run(self) -> None:
        assert NGINX is not None, "there is no nginx: run scripts/setup.sh"
        command = [NGINX, "-p", str(self.folder), "-c", str(self.folder / "nginx.conf"), "-e", str(self.folder / "nginx.log")]
        checked = subprocess.run([*command, "-t"], capture_output=True, text=True)
        assert checked.returncode == 0, checked.stderr
        self._nginx = subprocess.Popen([*command, "-g", "daemon off;"], stderr=subprocess.DEVNULL)
        assert wait_until(self._answers), self.nginx_log()

    def _answers(self) -> bool:
        with socket.socket() as probe:
            return probe.connect_ex(("127.0.0.1", self.port)) == 0

    def _write(self) -> None:
        """deploy's own file with addresses and certificates replaced, and what nginx.conf has around it."""
        text = (ROOT / "deploy/nginx/patchmill.conf").read_text()
        lines = re.findall(r"^ *server (patchmill-\d\.example:50051)( .*;)$", text, re.MULTILINE)
        assert len(lines) == 2, lines
        ours = [f"  server {server.address}{lines[0][1]}" for server in self.servers]
        text = replaced(text, f"  server {lines[0][0]}{lines[0][1]}\n", "")
        text = replaced(text, f"  server {lines[1][0]}{lines[1][1]}", "\n".join(ours))
        text = replaced(text, "listen 443 ssl", f"listen 127.0.0.1:{self.port} ssl")
        text = replaced(text, "/etc/nginx/tls/patchmill.crt", self._front[0])
        text = replaced(text, "/etc/nginx/tls/patchmill.key", self._front[1])
        text = replaced(text, "/etc/nginx/tls/patchmill-ca.crt", self.ca)
        (self.folder / "patchmill.conf").write_text(text)
        kinds = ("client_body", "proxy", "fastcgi", "uwsgi", "scgi")
        places = "".join(f"  {kind}_temp_path {self.folder}/nginx-{kind};\n" for kind in kinds)
        user = "user root;\n" if os.geteuid() == 0 else ""  # the folder is of this user only
        (self.folder / "nginx.conf").write_text(
            f"{user}worker_processes 1;\npid {self.folder}/nginx.pid;\nerror_log {self.folder}/nginx.log notice;\n"
            f"events {{}}\nhttp {{\n{places}  include {self.folder}/patchmill.conf;\n}}\n")


def package(folder: pathlib.Path) -> Any:
    """The Python package of clients/python, made in a folder."""
    target = folder / "package" / "patchmill"
    shutil.copytree(ROOT / "clients/python/src/patchmill", target, ignore=shutil.ignore_patterns("__pycache__"))
    sys.path.insert(0, str(ROOT / "clients/python"))
    importlib.import_module("build_wheel").make_stubs(target)
    sys.path.insert(0, str(target.parent))
    return importlib.import_module("patchmill")
