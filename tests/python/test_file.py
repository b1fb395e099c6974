"""Where results go: into new files, through links, over older files, into pipes."""
import os
import pathlib
import stat
import subprocess
import sys
import tempfile
import threading
import unittest

from patchmill._file import write_file

PROGRAM = b"G21 G90\nM30\n" * 20000  # more than a pipe holds


class Files(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)

    def names(self) -> list[str]:
        return sorted(p.name for p in self.folder.iterdir())

    def test_a_new_file_has_the_usual_mode(self):
        plain = self.folder / "plain"
        plain.touch()
        for name in ("part.ngc", "n" * 255):
            write_file(self.folder / name, PROGRAM)
            self.assertEqual((self.folder / name).read_bytes(), PROGRAM)
            self.assertEqual((self.folder / name).stat().st_mode, plain.stat().st_mode)
        self.assertEqual(self.names(), ["n" * 255, "part.ngc", "plain"])

    def test_an_older_file_hands_on_its_mode(self):
        part = self.folder / "part.ngc"
        part.write_bytes(b"old")
        part.chmod(0o640)
        write_file(part, PROGRAM)
        self.assertEqual(part.read_bytes(), PROGRAM)
        self.assertEqual(stat.S_IMODE(part.stat().st_mode), 0o640)

    def test_who_reads_the_older_file_keeps_it_whole(self):
        part = self.folder / "part.ngc"
        part.write_bytes(b"old")
        with part.open("rb") as reader:
            write_file(part, PROGRAM)
            self.assertEqual(reader.read(), b"old")

    def test_links_stay_and_their_targets_are_replaced(self):
        (self.folder / "deep").mkdir()
        (self.folder / "deep/part.ngc").write_bytes(b"old")
        (self.folder / "deep/part.ngc").chmod(0o600)
        (self.folder / "first").symlink_to("deep/second")
        (self.folder / "deep/second").symlink_to("../deep/part.ngc")
        write_file(self.folder / "first", PROGRAM)
        self.assertTrue((self.folder / "first").is_symlink() and (self.folder / "deep/second").is_symlink())
        self.assertFalse((self.folder / "deep/part.ngc").is_symlink())
        self.assertEqual((self.folder / "deep/part.ngc").read_bytes(), PROGRAM)
        self.assertEqual(stat.S_IMODE((self.folder / "deep/part.ngc").stat().st_mode), 0o600)

    def test_a_link_to_nothing_gets_its_target(self):
        (self.folder / "link").symlink_to("part.ngc")
        write_file(self.folder / "link", PROGRAM)
        self.assertTrue((self.folder / "link").is_symlink())
        self.assertEqual((self.folder / "part.ngc").read_bytes(), PROGRAM)

    def test_what_cannot_be_written_is_an_error_and_leaves_nothing(self):
        (self.folder / "a").symlink_to("b")
        (self.folder / "b").symlink_to("a")
        (self.folder / "deep").mkdir()
        for name, error in (("a", OSError), ("deep", IsADirectoryError), ("none/part.ngc", FileNotFoundError)):
            with self.assertRaises(error) as caught:
                write_file(self.folder / name, PROGRAM)
            self.assertEqual(str(caught.exception.filename), str(self.folder / name))
        part = self.folder / "part.ngc"
        part.write_bytes(b"old")
        with self.assertRaises(TypeError):
            write_file(part, "text")
        self.assertEqual(part.read_bytes(), b"old")
        self.assertEqual(self.names(), ["a", "b", "deep", "part.ngc"])

    def test_a_pipe_is_written_and_stays_a_pipe(self):
        pipe = self.folder / "pipe"
        os.mkfifo(pipe)
        (self.folder / "link").symlink_to("pipe")
        for path in (pipe, self.folder / "link"):
            read: list[bytes] = []
            reader = threading.Thread(target=lambda: read.append(pipe.read_bytes()))
            reader.start()
            write_file(path, PROGRAM)
            reader.join()
            self.assertEqual(read, [PROGRAM])
            self.assertTrue(stat.S_ISFIFO(pipe.stat().st_mode))
        self.assertEqual(self.names(), ["link", "pipe"])

    def test_an_open_file_is_written_at_its_end(self):
        part = self.folder / "part.ngc"
        with part.open("wb") as file:
            file.write(b"before\n")
            file.flush()
            write_file(f"/proc/self/fd/{file.fileno()}", PROGRAM)
            self.assertEqual(os.fstat(file.fileno()).st_ino, part.stat().st_ino)
        self.assertEqual(part.read_bytes(), b"before\n" + PROGRAM)

    def test_the_standard_output_keeps_what_was_printed_before(self):
        code = "import sys; from patchmill._file import write_file\n" \
               "print('before'); write_file('/dev/stdout', b'program\\n'); print('after')"
        with (self.folder / "out").open("wb") as out:
            subprocess.run([sys.executable, "-c", code], stdout=out, check=True)
        self.assertEqual((self.folder / "out").read_bytes(), b"before\nprogram\nafter\n")


if __name__ == "__main__":
    unittest.main()
