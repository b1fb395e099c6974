"""The client for asyncio."""
import asyncio
import os
import signal
import unittest

import patchmill as pm
from support import DOME, HILLS, NO_RETRY, daemon, free_port, long_operation, operation

MODEL = pm.Model.from_patches(DOME, name="dome")


class Async(unittest.IsolatedAsyncioTestCase):
    async def test_two_jobs_at_once(self):
        seen = {"dome": 0, "hills": 0}

        def count(name):
            def add(progress):
                seen[name] += 1
            return add

        async with pm.AsyncClient() as client:
            dome, hills = await asyncio.gather(client.mill(MODEL, operation(), progress=count("dome"), outputs=()),
                                               client.mill(HILLS, operation(), progress=count("hills")))
            alone = await client.mill(MODEL, operation(), outputs=())
        self.assertEqual(dome.program_bytes, alone.program_bytes)
        self.assertTrue(hills.has_program)
        self.assertGreater(len(hills.path), 100)
        self.assertTrue(seen["dome"] and seen["hills"])

    async def test_the_loop_goes_on_while_a_job_runs(self):
        async with pm.AsyncClient() as client:
            await client.posts()
            job = asyncio.create_task(client.mill(HILLS, operation(), outputs=()))
            ticks = 0
            while not job.done():
                await asyncio.sleep(0.01)
                ticks += 1
            await job
        self.assertGreater(ticks, 10)

    async def test_cancelling_a_task_ends_its_job(self):
        with daemon("--max-jobs", "1", "--max-queue", "0") as server:
            async with pm.AsyncClient(server.address, retry=NO_RETRY) as client:
                began = asyncio.Event()
                job = asyncio.create_task(client.mill(HILLS, long_operation(), progress=lambda p: began.set()))
                await began.wait()
                with self.assertRaises(pm.ServerBusyError):
                    await client.regions(MODEL, operation())
                job.cancel()
                with self.assertRaises(asyncio.CancelledError):
                    await job
                # The server is free again.
                async with pm.AsyncClient(server.address) as patient:
                    self.assertTrue((await patient.regions(MODEL, operation())).regions)

    async def test_cancel_deadline_and_errors(self):
        async with pm.AsyncClient() as client:
            cancel = pm.Canceller()
            with self.assertRaises(pm.JobCancelledError):
                await client.mill(HILLS, long_operation(), progress=lambda p: cancel(), cancel=cancel)
            with self.assertRaises(pm.JobCancelledError):
                await client.check(MODEL, cancel=cancel)
            with self.assertRaises(pm.DeadlineError):
                await client.mill(HILLS, long_operation(), timeout_s=0.4)
            with self.assertRaisesRegex(pm.InvalidRequestError, "scallop_mm = 9"):
                await client.mill(HILLS, operation(9))
            with self.assertRaises(ZeroDivisionError):
                await client.mill(HILLS, long_operation(), progress=lambda p: 1 / 0)

    async def test_a_server_that_is_lost_or_not_there(self):
        async with pm.AsyncClient() as client:
            began = asyncio.Event()
            job = asyncio.create_task(client.mill(HILLS, long_operation(), progress=lambda p: began.set()))
            await began.wait()
            os.kill(client._target._own.running.process.pid, signal.SIGKILL)
            with self.assertRaisesRegex(pm.ServerLostError, "signal 9"):
                await job
            self.assertTrue((await client.check(MODEL)).is_usable)
        async with pm.AsyncClient(f"127.0.0.1:{free_port()}", retry=pm.Retry(attempts=2, first_wait_s=0.05)) as nobody:
            with self.assertRaises(pm.ServerUnreachableError):
                await nobody.posts()

    async def test_a_digest_is_followed_by_the_model(self):
        async with pm.AsyncClient() as client:
            checked = await client.check(pm.Model.from_digest(bytes(32), MODEL))
            self.assertTrue(checked.is_usable)


if __name__ == "__main__":
    unittest.main()
