"""TJ-FlyingFish, a quadrotor of air and water with tilting rotors."""
