#!/bin/sh
# A worker that does what the text of its scenario says, which is a shell script.
eval "$(cat)"
