"""Certificates: each mistake is named at the start, and new files count without a restart."""
import pathlib
import shutil
import subprocess
import unittest

import grpc
from certificates import Authority
from support import PATCHMILLD, Folder, Server, call, health, refused, wait_until


def read(path):
    return pathlib.Path(path).read_bytes()


def channel_to(server, ca, cert=None, key=None):
    credentials = grpc.ssl_channel_credentials(read(ca), key and read(key), cert and read(cert))
    return grpc.secure_channel(server.address.replace("127.0.0.1", "localhost"), credentials)


class Tls(unittest.TestCase):
    def setUp(self):
        self.folder = self.enterContext(Folder())
        self.authority = Authority(self.folder.path)

    def test_each_mistake_is_named(self):
        cert, key = self.authority.sign("server")
        _, other_key = self.authority.sign("other")
        expired, expired_key = self.authority.sign("expired", begins=-5, days=2)
        early, early_key = self.authority.sign("early", begins=3)
        encrypted = str(self.folder.path / "encrypted.key")
        subprocess.run(["openssl", "pkey", "-in", key, "-aes256", "-passout", "pass:x", "-out", encrypted], check=True)
        damaged = self.folder.write("damaged.pem", pathlib.Path(cert).read_text().replace("MI", "!!", 1))
        text = self.folder.write("text.pem", "hello\n")
        for flags, words in [
            (["--cert", cert], "--cert and --key belong together"),
            (["--key", key], "--cert and --key belong together"),
            (["--ca", self.authority.ca], "--ca needs --cert and --key"),
            (["--cert", cert + "x", "--key", key], "--cert " + cert + "x: cannot be read: No such file"),
            (["--cert", cert, "--key", key + "x"], "--key " + key + "x: cannot be read: No such file"),
            (["--cert", str(self.folder.path), "--key", key], "cannot be read: Is a directory"),
            (["--cert", text, "--key", key], "holds no certificate in PEM form"),
            (["--cert", key, "--key", key], "holds a private key; a certificate belongs here"),
            (["--cert", damaged, "--key", key], "its certificate is damaged"),
            (["--cert", cert, "--key", cert], "holds a certificate; a private key belongs here"),
            (["--cert", cert, "--key", text], "holds no private key in PEM form"),
            (["--cert", cert, "--key", encrypted], "the key is encrypted"),
            (["--cert", cert, "--key", other_key], "the key is not that of the first certificate in --cert"),
            (["--cert", expired, "--key", expired_key], "the certificate expired at 20"),
            (["--cert", early, "--key", early_key], "the certificate is not valid before 20"),
            (["--cert", cert, "--key", key, "--ca", text], "--ca " + text + ": holds no certificate"),
            (["--cert", cert, "--key", key, "--ca", expired], "--ca " + expired + ": the certificate expired"),
        ]:
            status, message = refused(*flags)
            self.assertEqual((status, message.count("\n")), (2, 1), (flags, message))
            self.assertIn(words, message)

    def test_a_new_certificate_counts_without_a_restart(self):
        cert, key = self.authority.sign("server")
        with Server("--cert", cert, "--key", key) as server:
            with channel_to(server, self.authority.ca) as before:
                self.assertEqual(health(before), "SERVING")
                other = Authority(self.folder.path, "other-ca")
                new_cert, new_key = other.sign("new")
                shutil.copy(new_cert, cert)  # for a moment the key is that of another certificate
                self.assertTrue(server.logged("the certificates of before stay"))
                with channel_to(server, self.authority.ca) as meanwhile:
                    self.assertEqual(health(meanwhile), "SERVING")
                shutil.copy(new_key, key)

                def is_new():
                    with channel_to(server, other.ca) as after:
                        return health(after) == "SERVING"

                self.assertTrue(wait_until(is_new))
                self.assertEqual(health(before), "SERVING")  # an open connection stays
            with channel_to(server, self.authority.ca) as old:
                self.assertEqual(health(old), "UNAVAILABLE")

    def test_certificates_of_clients(self):
        cert, key = self.authority.sign("server")
        client, client_key = self.authority.sign("shop")
        stranger, stranger_key = Authority(self.folder.path, "stranger-ca").sign("stranger")
        with Server("--cert", cert, "--key", key, "--ca", self.authority.ca) as server:
            with channel_to(server, self.authority.ca, client, client_key) as known:
                self.assertEqual(call(known, "ListPosts").code, "OK")
            self.assertTrue(server.logged("caller=shop"))
            with channel_to(server, self.authority.ca) as nobody:
                self.assertEqual(health(nobody), "UNAVAILABLE")
            self.assertTrue(server.logged("the client showed no certificate"))
            with channel_to(server, self.authority.ca, stranger, stranger_key) as unknown:
                self.assertEqual(health(unknown), "UNAVAILABLE")
            self.assertTrue(server.logged("the certificate of the client is of no authority of --ca"))

    def test_the_health_check_over_tls_with_a_host_name(self):
        cert, key = self.authority.sign("server")
        with Server("--cert", cert, "--key", key) as server:
            port = server.address.split(":")[1]
            for flags, status in [(["--ca", self.authority.ca], 0), ([], 1)]:
                ended = subprocess.run([PATCHMILLD, "--check-health", f"localhost:{port}", *flags], capture_output=True, timeout=30)
                self.assertEqual(ended.returncode, status, ended.stderr)


if __name__ == "__main__":
    unittest.main()
