# One process that has everything loaded runs the stages of all designs, each in a fork of its own:
# imports and compiled kernels are paid once a run, not five times a design. Without it, on other
# machines of a cluster or by hand, the same commands run by themselves.

from pagd.cli import server


onstart:
    server.start()
    # To limit the jobs per second, which a cluster may want, Snakemake sets a timer for each job that
    # ends, and another one whenever one has run out: after thousands of jobs it does little else.
    if workflow.local_exec:
        workflow.scheduler.job_rate_limiter = None
