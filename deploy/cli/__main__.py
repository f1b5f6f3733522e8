"""`python -m deploy.cli`: the same as `odourswarm`."""

from deploy.cli.app import main

main()
